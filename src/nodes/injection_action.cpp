#include "nodes/injection_action.h"

#include <limits>

namespace microinjection {
namespace {

constexpr double kFeedback = 0.1;  ///< s between two

InjectionGoal toGoal(const cell_microinjection::InjectGoal& message) {
  InjectionGoal goal;
  goal.puncture = message.puncture;
  goal.layers = message.layers;
  goal.depth = message.depth;
  goal.margin = message.margin;
  goal.hold_time = message.hold_time;
  goal.pulse.pressure = message.pressure;
  goal.pulse.duration = message.duration;
  goal.pulse.volume = message.volume;
  return goal;
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
  return message;
}

}  // namespace

InjectionAction::InjectionAction(const ros::NodeHandle& node, InjectionController& controller,
                                 const InjectionGoal& configured)
    : controller_(controller), configured_(configured), server_(node, "controller/inject", false) {
  server_.start();
}

void InjectionAction::step(const ros::Time& now) {
  if (serving_ && server_.isPreemptRequested() && !withdrawn_) {
    withdrawn_ = true;
    controller_.withdraw();  // refused where there is nothing to withdraw from: then it is over already
  }
  if (serving_ && !controller_.running()) end();
  if (!serving_ && server_.isNewGoalAvailable()) begin();
  if (serving_ && (now - told_).toSec() >= kFeedback) tell(now);
}

void InjectionAction::begin() {
  const auto goal = server_.acceptNewGoal();
  const std::string refusal = controller_.start(goal->configured ? configured_ : toGoal(*goal));
  if (refusal.empty()) {
    serving_ = true;
    withdrawn_ = false;
    told_ = ros::Time();
    return;
  }
  ROS_WARN_STREAM("injection refused: " << refusal);
  cell_microinjection::InjectResult result = toMessage({});
  result.outcome = "refused";
  result.reason = refusal;
  server_.setAborted(result, refusal);
}

void InjectionAction::end() {
  serving_ = false;
  const InjectionResult& result = controller_.result();
  const auto message = toMessage(result);
  switch (result.outcome) {
    case InjectionOutcome::kInjected:
    case InjectionOutcome::kPunctured:
    case InjectionOutcome::kIndented:
      server_.setSucceeded(message, result.reason);
      break;
    case InjectionOutcome::kPreempted:
      server_.setPreempted(message, result.reason);
      break;
    default:
      server_.setAborted(message, result.reason);
  }
}

void InjectionAction::tell(const ros::Time& now) {
  const InjectionFeedback& known = controller_.feedback();
  cell_microinjection::InjectFeedback feedback;
  feedback.state = toText(known.state);
  feedback.waits = controller_.waits();
  feedback.layer = known.layer;
  feedback.layers = known.layers;
  feedback.force = known.force;
  feedback.depth = known.depth;
  feedback.elapsed = known.elapsed;
  server_.publishFeedback(feedback);
  told_ = now;
}

}  // namespace microinjection
