#include "nodes/injection/inject_server.h"

#include <cmath>
#include <iterator>
#include <sstream>

#include "nodes/runtime/message_guard.h"

namespace microinjection {
namespace {

constexpr double kStatusPeriod = 0.2;  // s
constexpr double kStatusKept = 5;      // s, time after its end in which a goal's status is published
constexpr std::uint32_t kQueue = 50;   // messages, as in actionlib's own server

/// Empty, or the error of the stamp. Before the clock starts, any stamp is accepted.
std::string aheadOfTime(const ros::Time& stamp) {
  const ros::Time now = ros::Time::now();
  if (now.isZero() || !isAhead(stamp, now)) return "";
  std::ostringstream text;
  text << "its stamp is " << secondsBetween(now, stamp) << " s ahead of the time, allowed " << kLargestLead << " s";
  return text.str();
}

}  // namespace

InjectServer::InjectServer(const ros::NodeHandle& node, const OnGoal& on_goal,
                           const std::function<void(GoalHandle)>& on_cancel)
    : ActionServerBase([this, on_goal](GoalHandle goal) { on_goal(goal, refusal_); }, on_cancel),
      node_(node, "controller/inject") {
  start();
}

void InjectServer::initialize() {
  status_ = node_.advertise<actionlib_msgs::GoalStatusArray>("status", kQueue, true);
  result_ = node_.advertise<ActionResult>("result", kQueue);
  feedback_ = node_.advertise<ActionFeedback>("feedback", kQueue);
  using Goal = boost::shared_ptr<const ActionGoal>;
  using Cancel = boost::shared_ptr<const actionlib_msgs::GoalID>;
  goals_ = node_.subscribe<ActionGoal>("goal", kQueue, [this](const Goal& goal) {
    refusal_.clear();  // may be left from a goal whose callback has thrown
    runGuarded("goal", [&] { receiveGoal(goal); });
  });
  cancels_ = node_.subscribe<actionlib_msgs::GoalID>(
      "cancel", kQueue, [this](const Cancel& cancel) { runGuarded("cancel", [&] { receiveCancel(cancel); }); });
}

void InjectServer::receiveGoal(const boost::shared_ptr<const ActionGoal>& message) {
  refusal_ = aheadOfTime(message->goal_id.stamp);
  if (refusal_.empty()) return goalCallback(message);
  const auto refused = boost::make_shared<ActionGoal>(*message);
  refused->goal_id.stamp = ros::Time::now();
  goalCallback(refused);
  refusal_.clear();
}

void InjectServer::receiveCancel(const actionlib_msgs::GoalIDConstPtr& message) {
  const std::string wrong = aheadOfTime(message->stamp);
  if (wrong.empty()) {
    cancelCallback(message);
  } else {
    ROS_WARN_STREAM("a cancel of " << (message->id.empty() ? "all goals" : "goal " + message->id) << ": " << wrong
                                   << "; no later goal is cancelled");
    const auto timeless = boost::make_shared<actionlib_msgs::GoalID>(*message);
    timeless->stamp = ros::Time();
    cancelCallback(timeless);
  }
  last_cancel_ = ros::Time();  // otherwise it would recall later goals
}

void InjectServer::publishResult(const actionlib_msgs::GoalStatus& status, const Result& result) {
  ActionResult message;
  message.header.stamp = ros::Time::now();
  message.status = status;
  message.result = result;
  result_.publish(message);
  publishStatus();
}

void InjectServer::publishFeedback(const actionlib_msgs::GoalStatus& status, const Feedback& feedback) {
  ActionFeedback message;
  message.header.stamp = ros::Time::now();
  message.status = status;
  message.feedback = feedback;
  feedback_.publish(message);
}

void InjectServer::publishStatus() {
  const ros::Time now = ros::Time::now();
  actionlib_msgs::GoalStatusArray message;
  message.header.stamp = now;
  for (auto tracker = status_list_.begin(); tracker != status_list_.end();) {
    message.status_list.push_back(tracker->status_);
    // The cancel of a goal that never arrived has no handle with a time.
    const bool over = tracker->handle_tracker_.expired();
    if (over && tracker->handle_destruction_time_.isZero()) tracker->handle_destruction_time_ = now;
    const double age = std::abs(secondsBetween(tracker->handle_destruction_time_, now));
    tracker = over && age > kStatusKept ? status_list_.erase(tracker) : std::next(tracker);
  }
  status_.publish(message);
  published_ = now;
}

void InjectServer::step(const ros::Time& now) {
  if (std::abs(secondsBetween(published_, now)) >= kStatusPeriod) publishStatus();
}

}  // namespace microinjection
