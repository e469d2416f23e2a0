#pragma once

#include <actionlib/action_definition.h>
#include <actionlib_msgs/GoalID.h>
#include <actionlib_msgs/GoalStatusArray.h>

#include <memory>
#include <string>
#include <vector>

#include "test_node.h"

namespace microinjection {

/// A test's client of an action. What it tells is of the last goal that it sent.
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

  void send(const Goal& goal) { send(goal, node_.bus().now()); }
  /// With a stamp, and an id (empty: one of its own), that need not be sound.
  void send(const Goal& goal, const ros::Time& stamp, const std::string& id = "") {
    ActionGoal message;
    message.header.stamp = node_.bus().now();
    message.goal_id.stamp = stamp;
    message.goal_id.id = id_ = id.empty() ? "goal " + std::to_string(++sent_) : id;
    message.goal = goal;
    node_.say(action_ + "/goal", message);
  }
  void cancel() { cancel(id_, ros::Time()); }
  /// Of actionlib: all goals up to the stamp, and the one with the id; stamp 0 and no id: all goals.
  void cancel(const std::string& id, const ros::Time& stamp) {
    actionlib_msgs::GoalID message;
    message.id = id;
    message.stamp = stamp;
    node_.say(action_ + "/cancel", message);
  }

  const std::string& id() const { return id_; }
  /// Null: the goal has not ended.
  const Result* result() const {
    const ActionResult* ended = end();
    return ended ? &ended->result : nullptr;
  }
  bool ended() const { return end() != nullptr; }
  /// A state of actionlib_msgs/GoalStatus; PENDING of a goal that the server does not know.
  int state() const {
    if (const ActionResult* ended = end()) return ended->status.status;
    if (status_.newest()) {
      for (const auto& status : status_.newest()->status_list) {
        if (status.goal_id.id == id_) return status.status;
      }
    }
    return actionlib_msgs::GoalStatus::PENDING;
  }
  std::vector<Feedback> feedback() const {
    std::vector<Feedback> all;
    for (const auto& message : feedback_.all()) {
      if (message->status.goal_id.id == id_) all.push_back(message->feedback);
    }
    return all;
  }
  /// Of all goals, of other clients, too.
  const Probe<ActionResult>& results() const { return results_; }
  const Probe<actionlib_msgs::GoalStatusArray>& status() const { return status_; }

 private:
  const ActionResult* end() const {
    for (const auto& message : results_.all()) {
      if (message->status.goal_id.id == id_) return message.get();
    }
    return nullptr;
  }

  TestNode& node_;
  std::string action_, id_;
  int sent_ = 0;
  const Probe<ActionResult>& results_;
  const Probe<ActionFeedback>& feedback_;
  const Probe<actionlib_msgs::GoalStatusArray>& status_;
};

}  // namespace microinjection
