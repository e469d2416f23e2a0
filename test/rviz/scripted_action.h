#pragma once

#include <string>
#include <vector>

#include "nodes/bus/action_server.h"

namespace microinjection {

/// The test as the node of an action: a goal lasts until it is cancelled, or the test ends it.
template <typename Action>
class ScriptedAction {
 public:
  ACTION_DEFINITION(Action)

  ScriptedAction(Bus& bus, const std::string& action)
      : bus_(bus),
        server_(
            bus, action,
            [this](GoalHandle goal, const std::string&) {
              goals.push_back(*goal.getGoal());
              goal_ = goal;
              goal_.setAccepted();
            },
            [this](GoalHandle goal) { goal.setCanceled(when_cancelled, cancel_text); }),
        timer_(bus.timer(0.05, [this] {
          server_.step(bus_.now());
          if (active()) goal_.publishFeedback(feedback);
        })) {}

  bool active() const { return goal_.isValid() && goal_.getGoalStatus().status == actionlib_msgs::GoalStatus::ACTIVE; }
  void succeed(const Result& result) { goal_.setSucceeded(result); }
  void abort(const Result& result, const std::string& text = "") { goal_.setAborted(result, text); }

  std::vector<Goal> goals;  ///< that have come
  Feedback feedback;        ///< of a goal, twenty times a second
  Result when_cancelled;
  std::string cancel_text;

 private:
  using GoalHandle = typename ActionServer<Action>::GoalHandle;

  Bus& bus_;
  GoalHandle goal_;  ///< the last one
  ActionServer<Action> server_;
  BusHandle timer_;
};

}  // namespace microinjection
