#pragma once

#include <actionlib/server/action_server_base.h>
#include <ros/console.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <string>

#include "nodes/bus/bus.h"
#include "nodes/runtime/message_guard.h"

namespace microinjection {

/// Empty, or the error of a goal's or cancel's stamp. Before the clock starts, any stamp is accepted.
std::string aheadOfTime(const ros::Time& stamp, const ros::Time& now);

/// The topics of an action on a bus, with actionlib's protocol and goal states, but its own rule for
/// stamps. Goals and cancels count in the order of their arrival; a stamp only selects the present
/// goals of a cancel without an id. A stamp in the future therefore affects only its own message:
///
/// - A goal more than 1 s ahead is passed on with the reason for its refusal.
/// - A cancel more than 1 s ahead is reported and applies to the goal with its id or, without an
///   id, to all present goals. To end a goal is the safe reaction.
///
/// It has no thread and no timer: callbacks run as those of the bus, and step() publishes the status.
template <typename Action>
class ActionServer : public actionlib::ActionServerBase<Action> {
  using Base = actionlib::ActionServerBase<Action>;

 public:
  ACTION_DEFINITION(Action)
  using typename Base::GoalHandle;
  /// `refusal`: why the goal must not begin; empty: it may.
  using OnGoal = std::function<void(GoalHandle goal, const std::string& refusal)>;

  /// Subscribes at once. `on_cancel` receives every goal that shall end, once.
  ActionServer(Bus& bus, const std::string& action, const OnGoal& on_goal,
               const std::function<void(GoalHandle)>& on_cancel)
      : Base([this, on_goal](GoalHandle goal) { on_goal(goal, refusal_); }, on_cancel), bus_(bus), action_(action) {
    this->start();
  }

  /// Publishes the status of the goals five times a second.
  void step(const ros::Time& now) {
    if (std::abs(secondsBetween(published_, now)) >= kStatusPeriod) publishStatus();
  }

 private:
  static constexpr double kStatusPeriod = 0.2;  // s
  static constexpr double kStatusKept = 5;      // s, time after its end in which a goal's status is published
  static constexpr std::uint32_t kQueue = 50;   // messages, as in actionlib's own server

  void initialize() override;
  void publishResult(const actionlib_msgs::GoalStatus& status, const Result& result) override;
  void publishFeedback(const actionlib_msgs::GoalStatus& status, const Feedback& feedback) override;
  void publishStatus() override;
  void receiveGoal(const ActionGoalConstPtr& message);
  void receiveCancel(const actionlib_msgs::GoalIDConstPtr& message);

  Bus& bus_;
  std::string action_;
  std::string refusal_;  ///< of the goal that is passed on
  ros::Time published_;  ///< the status
  Publisher<actionlib_msgs::GoalStatusArray> status_;
  Publisher<ActionResult> result_;
  Publisher<ActionFeedback> feedback_;
  Subscription goals_, cancels_;
};

template <typename Action>
void ActionServer<Action>::initialize() {
  status_ = bus_.advertise<actionlib_msgs::GoalStatusArray>(action_ + "/status", kQueue, true);
  result_ = bus_.advertise<ActionResult>(action_ + "/result", kQueue);
  feedback_ = bus_.advertise<ActionFeedback>(action_ + "/feedback", kQueue);
  goals_ = bus_.subscribe<ActionGoal>(action_ + "/goal", kQueue, [this](const Delivery<ActionGoal>& goal) {
    refusal_.clear();  // may be left from a goal whose callback has thrown
    runGuarded(bus_.refusals(), "goal", [&] { receiveGoal(goal.message); });
  });
  using Cancel = actionlib_msgs::GoalID;
  cancels_ = bus_.subscribe<Cancel>(action_ + "/cancel", kQueue, [this](const Delivery<Cancel>& cancel) {
    runGuarded(bus_.refusals(), "cancel", [&] { receiveCancel(cancel.message); });
  });
}

template <typename Action>
void ActionServer<Action>::receiveGoal(const ActionGoalConstPtr& message) {
  refusal_ = aheadOfTime(message->goal_id.stamp, bus_.now());
  if (refusal_.empty()) return this->goalCallback(message);
  const auto refused = boost::make_shared<ActionGoal>(*message);
  refused->goal_id.stamp = bus_.now();
  this->goalCallback(refused);
  refusal_.clear();
}

template <typename Action>
void ActionServer<Action>::receiveCancel(const actionlib_msgs::GoalIDConstPtr& message) {
  const std::string wrong = aheadOfTime(message->stamp, bus_.now());
  if (wrong.empty()) {
    this->cancelCallback(message);
  } else {
    ROS_WARN_STREAM("a cancel of " << (message->id.empty() ? "all goals" : "goal " + message->id) << ": " << wrong
                                   << "; no later goal is cancelled");
    const auto timeless = boost::make_shared<actionlib_msgs::GoalID>(*message);
    timeless->stamp = ros::Time();
    this->cancelCallback(timeless);
  }
  this->last_cancel_ = ros::Time();  // otherwise it would recall later goals
}

template <typename Action>
void ActionServer<Action>::publishResult(const actionlib_msgs::GoalStatus& status, const Result& result) {
  ActionResult message;
  message.header.stamp = bus_.now();
  message.status = status;
  message.result = result;
  result_.publish(message);
  publishStatus();
}

template <typename Action>
void ActionServer<Action>::publishFeedback(const actionlib_msgs::GoalStatus& status, const Feedback& feedback) {
  ActionFeedback message;
  message.header.stamp = bus_.now();
  message.status = status;
  message.feedback = feedback;
  feedback_.publish(message);
}

template <typename Action>
void ActionServer<Action>::publishStatus() {
  const ros::Time now = bus_.now();
  actionlib_msgs::GoalStatusArray message;
  message.header.stamp = now;
  auto& goals = this->status_list_;
  for (auto tracker = goals.begin(); tracker != goals.end();) {
    message.status_list.push_back(tracker->status_);
    // The cancel of a goal that never arrived has no handle with a time.
    const bool over = tracker->handle_tracker_.expired();
    if (over && tracker->handle_destruction_time_.isZero()) tracker->handle_destruction_time_ = now;
    const double age = std::abs(secondsBetween(tracker->handle_destruction_time_, now));
    tracker = over && age > kStatusKept ? goals.erase(tracker) : std::next(tracker);
  }
  status_.publish(message);
  published_ = now;
}

}  // namespace microinjection
