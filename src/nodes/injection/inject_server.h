#pragma once

#include <actionlib/server/action_server_base.h>
#include <ros/ros.h>

#include <cstdint>
#include <functional>
#include <string>

#include "cell_microinjection/InjectAction.h"

namespace microinjection {

/// The topics of the action Inject with actionlib's protocol and states of goals, and a policy of its own for stamps.
/// The order of goals and cancels is that of their arrival: a stamp decides only which of the known goals a cancel
/// without an id is for. A stamp that is ahead of the time therefore costs its own message and no later one:
///
///     goal whose stamp is more than 1 s ahead    handed on with the reason for its refusal
///     cancel whose stamp is more than 1 s ahead  reported; it is for the goal with its id or, without an id, for all
///                                                that are known. To withdraw is the safe answer to either
///
/// It has no thread and no timer: callbacks run where those of the node handle do, and step() publishes the status.
class InjectServer : public actionlib::ActionServerBase<cell_microinjection::InjectAction> {
 public:
  /// `refusal`: why the goal must not be begun; empty where the server has nothing against it.
  using OnGoal = std::function<void(GoalHandle goal, const std::string& refusal)>;

  /// Listens at once. `on_cancel` gets every goal that is to end, once.
  InjectServer(const ros::NodeHandle& node, const OnGoal& on_goal, const std::function<void(GoalHandle)>& on_cancel);

  /// Publishes the status of the goals five times a second.
  void step(const ros::Time& now);

 private:
  void initialize() override;
  void publishResult(const actionlib_msgs::GoalStatus& status, const Result& result) override;
  void publishFeedback(const actionlib_msgs::GoalStatus& status, const Feedback& feedback) override;
  void publishStatus() override;
  void receiveGoal(const boost::shared_ptr<const ActionGoal>& message);
  void receiveCancel(const actionlib_msgs::GoalIDConstPtr& message);

  ros::NodeHandle node_;
  std::string refusal_;  ///< of the goal that is being handed on
  std::int64_t published_ns_ = 0;
  ros::Publisher status_, result_, feedback_;
  ros::Subscriber goals_, cancels_;
};

}  // namespace microinjection
