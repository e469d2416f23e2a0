#pragma once

#include <actionlib_msgs/GoalStatusArray.h>
#include <ros/ros.h>

#include <algorithm>
#include <string>

#include "rviz/session_clock.h"

namespace microinjection {

/// Whether an action has a goal of anybody that is not over. The callbacks run in the node handle's queue.
class ActionWatch {
 public:
  /// @param action  as "focus/find"
  ActionWatch(ros::NodeHandle& node, const std::string& action) {
    status_ = node.subscribe<actionlib_msgs::GoalStatusArray>(
        action + "/status", 1,
        boost::function<void(const actionlib_msgs::GoalStatusArray::ConstPtr&)>([this](const auto& message) {
          using actionlib_msgs::GoalStatus;
          const auto lasts = [](const GoalStatus& goal) {
            return goal.status == GoalStatus::PENDING || goal.status == GoalStatus::ACTIVE ||
                   goal.status == GoalStatus::PREEMPTING || goal.status == GoalStatus::RECALLING;
          };
          active_ = std::any_of(message->status_list.begin(), message->status_list.end(), lasts);
          heard_at_ = sessionNow();
        }));
  }
  bool active() const { return active_ && sessionNow() - heard_at_ < kSilence; }

 private:
  static constexpr double kSilence = 2;  ///< s, of a node that has ended

  bool active_ = false;
  double heard_at_ = -1e9;  ///< s, sessionNow()
  ros::Subscriber status_;
};

}  // namespace microinjection
