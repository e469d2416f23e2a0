// Commands of operators and programs to the controller.

#include <sstream>
#include <utility>

#include "operation/control/injection_controller.h"

namespace microinjection {

std::string InjectionController::command(const std::string& command) {
  std::string refusal = execute(command);
  notice_ = refusal.empty() ? "" : command + " refused: " + refusal;
  return refusal;
}

std::string InjectionController::execute(const std::string& command) {
  if (command == "approach") return start(config_.goal);
  if (command == "indent") return applyOperatorCommand(InjectionEvent::kIndent);
  if (command == "inject") return applyOperatorCommand(InjectionEvent::kInject);
  if (command == "withdraw") return withdraw();
  return applyCommand(command);
}

std::string InjectionController::applyCommand(const std::string& text) {
  const auto command = stateCommandOf(text);
  if (!command) {
    return "\"" + text +
           "\" is no command here; allowed: enable, disable, pause, resume, home, unhome, approach, indent, inject, "
           "withdraw";
  }
  std::string refusal = *command == StateCommand::kHome ? goHome() : change(*command);
  if (!refusal.empty()) return refusal;
  homing_ = *command == StateCommand::kHome;
  if (*command != StateCommand::kUnhome) paused_ = *command == StateCommand::kPause;
  monitor_.skip();  // the next motion does not continue the present one
  target_offset_.reset();
  withdrawal_.forgive();
  return "";
}

/// Applies CRTK's table, for all commands but home.
std::string InjectionController::change(StateCommand command) {
  const auto next = after(state_, command);
  if (!next) return refusalOf(state_, command);
  const OperatingState before = std::exchange(state_, *next);
  switch (command) {
    case StateCommand::kDisable:
      hold_reason_ = "DISABLED";
      setpoint_.reset();
      run_.end(InjectionOutcome::kDisabled, "disabled");
      apply(InjectionEvent::kReset);
      break;
    case StateCommand::kEnable:
      if (before != OperatingState::kEnabled) setpoint_.reset();
      if (before == OperatingState::kFault) apply(InjectionEvent::kReset);
      break;
    case StateCommand::kPause:
      hold_reason_ = "PAUSED";
      break;
    case StateCommand::kResume:
      run_.resetSpeed();
      break;
    case StateCommand::kUnhome:
      unhomed_ = true;
      run_.end(InjectionOutcome::kPreempted, "unhome");
      break;
    case StateCommand::kHome:
      break;
  }
  return "";
}

/// Unlike CRTK's table, PAUSED allows home, too: it withdraws a needle that a guard holds in the
/// cell.
std::string InjectionController::goHome() {
  const bool allowed = state_ == OperatingState::kEnabled || state_ == OperatingState::kPaused;
  if (!allowed) return std::string("state is ") + toText(state_) + ", home is allowed in ENABLED, PAUSED";
  if (!setpoint_) return "the needle's position is not known yet";
  state_ = OperatingState::kEnabled;
  run_.end(InjectionOutcome::kPreempted, "home");
  apply(InjectionEvent::kWithdraw);
  return "";
}

std::string InjectionController::start(const InjectionGoal& goal) {
  if (byHand()) return "mode is manual: the hand moves the needle";
  if (state_ != OperatingState::kEnabled)
    return std::string("state is ") + toText(state_) + ", an injection starts in ENABLED";
  if (unhomed_) return kNotHomed;
  if (!setpoint_) return "the needle's position is not known yet";
  if (homing_ || injection_ != InjectionState::kIdle) {
    return std::string("an injection starts in idle, the needle is in ") + (homing_ ? "homing" : toText(injection_));
  }
  if (monitor_.touched()) return "the needle is in the cell; withdraw or home takes it out";
  std::string problems = goal.problems();
  if (!problems.empty()) return problems;
  if (goal.depth > config_.guards.depth_limit) {
    std::ostringstream text;
    text << "depth = " << goal.depth << " m, allowed up to depth_limit = " << config_.guards.depth_limit << " m";
    return text.str();
  }
  run_.start(goal, *setpoint_);
  resetMonitors();
  apply(InjectionEvent::kStart);
  return "";
}

std::string InjectionController::applyOperatorCommand(InjectionEvent event) {
  if (state_ != OperatingState::kEnabled)
    return std::string("state is ") + toText(state_) + ", it is allowed in ENABLED";
  if (unhomed_) return kNotHomed;
  if (!byHand()) return run_.confirm(event, injection_);
  if (event != InjectionEvent::kInject) return "mode is manual: the hand moves the needle";
  if (injection_ != InjectionState::kPunctured) return std::string("it is no step from ") + toText(injection_);
  if (!hold_reason_.empty() && hold_reason_ != kNoTarget) return "the needle is held: " + hold_reason_;
  if (config_.goal.pulse.duration <= 0) return "the goal has no pulse";
  const std::string denied = contradiction();
  if (!denied.empty()) return denied;
  hand_pulse_.start(config_.goal.pulse, config_.motion.injector_timeout);
  pulse_by_hand_ = true;
  apply(InjectionEvent::kInject);
  return "";
}

std::string InjectionController::withdraw() {
  if (byHand()) return "mode is manual: the hand withdraws the needle, or home";
  const bool held = state_ == OperatingState::kEnabled || state_ == OperatingState::kPaused;
  if (!held) return std::string("state is ") + toText(state_) + ", withdraw is allowed in ENABLED and PAUSED";
  if (!setpoint_) return "the needle's position is not known yet";
  // A disabled injection left the needle in the cell: its start is known.
  if (injection_ == InjectionState::kIdle && monitor_.touched() && !homing_) return applyCommand("home");
  if (homing_ || !after(injection_, InjectionEvent::kWithdraw)) {
    return std::string("there is nothing to withdraw from in ") + (homing_ ? "homing" : toText(injection_));
  }
  state_ = OperatingState::kEnabled;
  run_.withdraw();
  apply(InjectionEvent::kWithdraw);
  return "";
}

}  // namespace microinjection
