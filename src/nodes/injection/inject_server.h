#pragma once

#include <actionlib/server/action_server_base.h>
#include <ros/ros.h>

#include <functional>
#include <string>

#include "cell_microinjection/InjectAction.h"

namespace microinjection {

/// The topics of the action Inject with actionlib's protocol and goal states, but its own rule for
/// stamps. Goals and cancels count in the order of their arrival; a stamp only selects the present
/// goals of a cancel without an id. A stamp in the future therefore affects only its own message:
///
/// - A goal more than 1 s ahead is passed on with the reason for its refusal.
/// - A cancel more than 1 s ahead is reported and applies to the goal with its id or, without an
///   id, to all present goals. Withdrawal is the safe reaction.
///
/// It has no thread and no timer: callbacks run with those of the node handle, and step() publishes
/// the status.
class InjectServer : public actionlib::ActionServerBase<cell_microinjection::InjectAction> {
 public:
  /// `refusal`: why the goal must not begin; empty: it may.
  using OnGoal = std::function<void(GoalHandle goal, const std::string& refusal)>;

  /// Subscribes at once. `on_cancel` receives every goal that shall end, once.
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
  std::string refusal_;  ///< of the goal that is passed on
  ros::Time published_;  ///< the status
  ros::Publisher status_, result_, feedback_;
  ros::Subscriber goals_, cancels_;
};

}  // namespace microinjection
