#pragma once

#include <actionlib/action_definition.h>
#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatusArray.h>

#include <algorithm>
#include <string>
#include <vector>

#include "test_node.h"

namespace microinjection {

/// Who asks for an action, by messages of the test's node, with any identity and stamp.
template <typename Action>
class ActionClient {
 public:
  ACTION_DEFINITION(Action)

  ActionClient(TestNode& node, const std::string& action)
      : node_(node),
        action_(action),
        results_(node.hear<ActionResult>(action + "/result")),
        feedback_(node.hear<ActionFeedback>(action + "/feedback")),
        status_(node.hear<actionlib_msgs::GoalStatusArray>(action + "/status")) {
    node.publisher<ActionGoal>(action + "/goal");
    node.publisher<actionlib_msgs::GoalID>(action + "/cancel");
  }

  /// From now on this goal is the own one. @returns its identity
  std::string send(const Goal& goal) { return own_ = send(goal, "goal " + std::to_string(++sent_), node_.bus().now()); }
  /// A goal of somebody else.
  std::string send(const Goal& goal, const std::string& id, const ros::Time& stamp) {
    ActionGoal message;
    message.goal_id.id = id;
    message.goal_id.stamp = stamp;
    message.goal = goal;
    node_.say(action_ + "/goal", message);
    return id;
  }
  /// Of the own goal.
  void cancel() { cancel(own_, ros::Time()); }
  void cancel(const std::string& id, const ros::Time& stamp) {
    actionlib_msgs::GoalID message;
    message.id = id;
    message.stamp = stamp;
    node_.say(action_ + "/cancel", message);
  }

  /// How the own goal has ended; null: it has not.
  const ActionResult* ended() const { return ended(own_); }
  const ActionResult* ended(const std::string& id) const {
    for (const auto& result : results_.all()) {
      if (result->status.goal_id.id == id) return result.get();
    }
    return nullptr;
  }
  /// Of all goals, in the order of their ends.
  const std::vector<boost::shared_ptr<const ActionResult>>& results() const { return results_.all(); }
  /// Of the own goal.
  std::vector<Feedback> feedback() const {
    std::vector<Feedback> own;
    for (const auto& message : feedback_.all()) {
      if (message->status.goal_id.id == own_) own.push_back(message->feedback);
    }
    return own;
  }
  /// Whether the newest status has this goal.
  bool knows(const std::string& id) const {
    const auto* const newest = status_.newest();
    return newest && std::any_of(newest->status_list.begin(), newest->status_list.end(),
                                 [&](const auto& status) { return status.goal_id.id == id; });
  }

 private:
  TestNode& node_;
  std::string action_, own_;
  int sent_ = 0;
  Probe<ActionResult>& results_;
  Probe<ActionFeedback>& feedback_;
  Probe<actionlib_msgs::GoalStatusArray>& status_;
};

}  // namespace microinjection
