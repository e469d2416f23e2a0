#pragma once

#include <actionlib_msgs/GoalStatusArray.h>

#include <algorithm>
#include <string>

#include "rviz/session_clock.h"
#include "rviz/task_runner.h"

namespace microinjection {

/// Whether an action has a goal of anybody that is not over.
class ActionWatch {
 public:
  /// @param action  as "focus/find"
  ActionWatch(Bus& bus, const std::string& action) : bus_(bus) {
    status_ = bus.subscribe<actionlib_msgs::GoalStatusArray>(action + "/status", 1, [this](const auto& delivery) {
      const auto& goals = delivery.message->status_list;
      active_ = !std::all_of(goals.begin(), goals.end(), isOver);
      heard_at_ = sessionNow(bus_);
    });
  }
  bool active() const { return active_ && sessionNow(bus_) - heard_at_ < kSilence; }

 private:
  static constexpr double kSilence = 2;  ///< s, of a node that has ended

  Bus& bus_;
  bool active_ = false;
  double heard_at_ = -1e9;  ///< s, sessionNow()
  Subscription status_;
};

}  // namespace microinjection
