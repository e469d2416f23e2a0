#include "nodes/injection/injection_action.h"

#include <cmath>
#include <limits>
#include <utility>

#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kFeedback = 0.1;  ///< s between two messages

InjectionGoal toGoal(const cell_microinjection::InjectGoal& message) {
  InjectionGoal goal;
  goal.puncture = message.puncture;
  goal.layers = message.layers;
  goal.depth = message.depth;
  goal.margin = message.margin;
  goal.hold_time = message.hold_time;
  if (message.break_by.empty() || message.break_by == toText(BreakBy::kForce)) {
    goal.break_by = BreakBy::kForce;  // the suction's numbers are not asked for
  } else {
    goal.break_by = *breakByOf(message.break_by);
    goal.suction = {message.dent, message.suction, message.suction_rate, message.suction_time, message.suction_length};
  }
  goal.pulse.pressure = message.pressure;
  goal.pulse.duration = message.duration;
  goal.pulse.volume = message.volume;
  if (message.holding_suction != 0 || message.release) {
    goal.holding = {message.holding_suction, message.holding_time, message.release != 0, message.release_pressure,
                    message.release_time};
  }
  return goal;
}

std::string problemsOf(const cell_microinjection::InjectGoal& message) {
  if (!message.break_by.empty() && !breakByOf(message.break_by))
    return "break_by = " + message.break_by + ", allowed force, suction, suction_then_force, force_then_suction";
  return toGoal(message).problems();
}

cell_microinjection::InjectResult toMessage(const InjectionResult& result) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  cell_microinjection::InjectResult message;
  message.outcome = toText(result.outcome);
  message.reason = result.reason;
  message.peak_force = result.peak_force;
  message.max_depth = result.max_depth;
  message.punctures = result.punctures;
  message.puncture_force = result.puncture_force.value_or(kNone);
  message.puncture_depth = result.puncture_depth.value_or(kNone);
  message.volume = result.volume;
  message.duration = result.duration;
  message.false_touches = result.false_touches;
  message.break_suction = result.break_suction;
  message.false_breaks = result.false_breaks;
  return message;
}

}  // namespace

InjectionAction::InjectionAction(Bus& bus, InjectionController& controller, const InjectionGoal& configured)
    : controller_(controller),
      configured_(configured),
      server_(
          bus, "controller/inject", [this](GoalHandle goal, const std::string& refusal) { receive(goal, refusal); },
          [this](GoalHandle goal) { cancel(goal); }) {}

void InjectionAction::receive(GoalHandle goal, const std::string& refusal) {
  const auto message = goal.getGoal();
  const std::string problems = message->configured ? "" : problemsOf(*message);
  if (!refusal.empty() || !problems.empty()) return refuse(goal, refusal.empty() ? problems : refusal);
  recall("replaced by a newer goal before it began");
  next_ = goal;
  end_requested_ = true;
}

void InjectionAction::cancel(GoalHandle goal) {
  if (current_.isValid() && goal == current_) end_requested_ = true;
  if (next_.isValid() && goal == next_) recall("cancelled before it began");
}

/// Cancels the waiting goal, if there is one.
void InjectionAction::recall(const std::string& reason) {
  if (!next_.isValid()) return;
  cell_microinjection::InjectResult result = toMessage(InjectionResult());
  result.outcome = toText(InjectionOutcome::kPreempted);
  result.reason = reason;
  next_.setCanceled(result, reason);
  next_ = GoalHandle();
}

void InjectionAction::refuse(GoalHandle goal, const std::string& refusal) {
  ROS_WARN_STREAM("injection refused: " << refusal);
  cell_microinjection::InjectResult result = toMessage(InjectionResult());
  result.outcome = "refused";
  result.reason = refusal;
  goal.setAccepted();
  goal.setAborted(result, refusal);
}

void InjectionAction::step(const ros::Time& now) {
  if (current_.isValid() && end_requested_ && !withdrawn_) {
    withdrawn_ = true;
    controller_.withdraw();  // refused without an injection: then it has ended already
  }
  if (current_.isValid() && !controller_.running()) end();
  if (!current_.isValid() && next_.isValid()) begin();
  if (current_.isValid() && std::abs(secondsBetween(fed_back_, now)) >= kFeedback) {
    publishFeedback();
    fed_back_ = now;
  }
  server_.step(now);
}

void InjectionAction::begin() {
  const GoalHandle goal = std::exchange(next_, GoalHandle());
  const auto message = goal.getGoal();
  const std::string refusal = controller_.start(message->configured ? configured_ : toGoal(*message));
  if (!refusal.empty()) return refuse(goal, refusal);
  current_ = goal;
  current_.setAccepted();
  end_requested_ = withdrawn_ = false;
  fed_back_ = ros::Time();
}

void InjectionAction::end() {
  GoalHandle goal = std::exchange(current_, GoalHandle());
  const InjectionResult& result = controller_.result();
  const auto message = toMessage(result);
  switch (result.outcome) {
    case InjectionOutcome::kInjected:
    case InjectionOutcome::kPunctured:
    case InjectionOutcome::kIndented:
      goal.setSucceeded(message, result.reason);
      break;
    case InjectionOutcome::kPreempted:
      goal.setCanceled(message, result.reason);
      break;
    default:
      goal.setAborted(message, result.reason);
  }
}

void InjectionAction::publishFeedback() {
  const InjectionFeedback& latest = controller_.feedback();
  cell_microinjection::InjectFeedback feedback;
  feedback.state = toText(latest.state);
  feedback.waits = controller_.awaitsCommand();
  feedback.layer = latest.layer;
  feedback.layers = latest.layers;
  feedback.force = latest.force;
  feedback.depth = latest.depth;
  feedback.elapsed = latest.elapsed;
  current_.publishFeedback(feedback);
}

}  // namespace microinjection
