#include "control/injection_controller.h"

#include <algorithm>
#include <sstream>

namespace microinjection {
namespace {

bool trusted(const std::optional<Eigen::Vector3d>& value) { return value && value->allFinite(); }

}  // namespace

InjectionControllerConfig InjectionControllerConfig::read(ConfigReader& reader) {
  InjectionControllerConfig config;
  reader.choice("mode", config.mode, {"manual", "semi_automatic", "automatic"});
  reader.boolean("start_when_enabled", config.start_when_enabled);
  config.guards = GuardConfig::read(reader);
  ConfigReader detection = reader.section("detection");
  config.detection = DetectionConfig::read(detection);
  ConfigReader motion = reader.section("motion");
  config.motion = InjectionMotionConfig::read(motion);
  for (const auto& [key, speed] : {std::pair("approach_speed", config.motion.approach_speed),
                                   {"stab_speed", config.motion.stab_speed},
                                   {"retract_speed", config.motion.retract_speed}}) {
    if (speed > config.guards.speed_limit) motion.error(key, "must not be above speed_limit");
  }
  ConfigReader goal = reader.section("goal");
  config.goal = InjectionGoal::read(goal);
  if (config.goal.depth > config.guards.depth_limit) goal.error("depth", "must not be above depth_limit");
  return config;
}

const char* toText(OperatingState state) {
  switch (state) {
    case OperatingState::kEnabled:
      return "ENABLED";
    case OperatingState::kPaused:
      return "PAUSED";
    case OperatingState::kFault:
      return "FAULT";
    default:
      return "DISABLED";
  }
}

InjectionController::InjectionController(const InjectionControllerConfig& config)
    : config_(config), monitor_(config.detection), run_(config.motion, config.guards, config.mode == "automatic") {}

bool InjectionController::busy() const {
  return state_ == OperatingState::kEnabled &&
         (homing_ || run_.active() || (!byHand() && injection_ == InjectionState::kWithdraw));
}

InjectionFeedback InjectionController::feedback() const {
  const InjectionGoal& goal = run_.goal();
  const int layer = goal.puncture ? run_.result().punctures + 1 : 0;
  const int layers = goal.puncture ? goal.layers : 0;
  return {injection_, layer, layers, monitor_.force(), monitor_.depth(), run_.result().duration};
}

std::optional<PulseGoal> InjectionController::pulse() const {
  if (injection_ != InjectionState::kInject) return std::nullopt;
  if (run_.active()) return run_.goal().pulse;
  return pulse_by_hand_ ? std::optional(config_.goal.pulse) : std::nullopt;
}

std::string InjectionController::command(const std::string& command) {
  if (command == "approach") return start(config_.goal);
  if (command == "indent") return takeWord(InjectionEvent::kIndent);
  if (command == "inject") return takeWord(InjectionEvent::kInject);
  if (command == "withdraw") return withdraw();
  return obey(command);
}

std::string InjectionController::obey(const std::string& command) {
  const std::string refusal = std::string("state is ") + toText(state_) + ", ";
  if (command == "disable") {
    state_ = OperatingState::kDisabled;
    held_because_ = "DISABLED";
    setpoint_.reset();
    run_.end(InjectionOutcome::kDisabled, "disabled");
    happen(InjectionEvent::kReset);
  } else if (command == "enable") {
    if (state_ == OperatingState::kFault) return refusal + "enable is allowed after disable";
    if (state_ == OperatingState::kDisabled) setpoint_.reset();
    state_ = OperatingState::kEnabled;
  } else if (command == "pause") {
    if (state_ != OperatingState::kEnabled) return refusal + "pause is allowed in ENABLED";
    state_ = OperatingState::kPaused;
    held_because_ = "PAUSED";
  } else if (command == "resume") {
    if (state_ != OperatingState::kPaused) return refusal + "resume is allowed in PAUSED";
    state_ = OperatingState::kEnabled;
  } else if (command == "home") {
    if (!setpoint_ || state_ == OperatingState::kFault) return refusal + "home is allowed in ENABLED and PAUSED";
    state_ = OperatingState::kEnabled;
    run_.end(InjectionOutcome::kPreempted, "home");
    happen(InjectionEvent::kWithdraw);
  } else {
    return "\"" + command +
           "\" is no command here; allowed: enable, disable, pause, resume, home, approach, indent, inject, withdraw";
  }
  homing_ = command == "home";
  monitor_.skip();  // what comes next is no sequel of the motion until now
  target_offset_.reset();
  return "";
}

std::string InjectionController::start(const InjectionGoal& goal) {
  if (byHand()) return "mode is manual: the hand moves the needle";
  if (state_ != OperatingState::kEnabled || !setpoint_)
    return std::string("state is ") + toText(state_) + ", an injection starts in ENABLED";
  if (homing_ || injection_ != InjectionState::kIdle) {
    return std::string("an injection starts in idle, the needle is in ") + (homing_ ? "homing" : toText(injection_));
  }
  const std::string problems = goal.problems();
  if (!problems.empty()) return problems;
  if (goal.depth > config_.guards.depth_limit) return "depth is above depth_limit";
  run_.start(goal, *setpoint_);
  monitor_.reset();
  happen(InjectionEvent::kStart);
  return "";
}

std::string InjectionController::takeWord(InjectionEvent event) {
  if (state_ != OperatingState::kEnabled)
    return std::string("state is ") + toText(state_) + ", it is allowed in ENABLED";
  if (!byHand()) return run_.confirm(event, injection_);
  if (event != InjectionEvent::kInject) return "mode is manual: the hand moves the needle";
  if (injection_ != InjectionState::kPunctured) return std::string("it is no step from ") + toText(injection_);
  if (config_.goal.pulse.duration <= 0) return "the goal has no pulse";
  hand_pulse_.start(config_.goal.pulse, config_.motion.injector_patience);
  pulse_by_hand_ = true;
  happen(InjectionEvent::kInject);
  return "";
}

std::string InjectionController::withdraw() {
  if (byHand()) return "mode is manual: the hand withdraws the needle, or home";
  const bool held = state_ == OperatingState::kEnabled || state_ == OperatingState::kPaused;
  if (!held || !setpoint_)
    return std::string("state is ") + toText(state_) + ", withdraw is allowed in ENABLED and PAUSED";
  if (homing_ || !after(injection_, InjectionEvent::kWithdraw)) {
    return std::string("there is nothing to withdraw from in ") + (homing_ ? "homing" : toText(injection_));
  }
  state_ = OperatingState::kEnabled;
  run_.withdraw();
  happen(InjectionEvent::kWithdraw);
  return "";
}

void InjectionController::happen(InjectionEvent event) {
  const auto next = after(injection_, event);
  if (!next) return;
  injection_ = *next;
  if (event == InjectionEvent::kPuncture) ++punctures_;
  if (event == InjectionEvent::kStart) {
    punctures_ = 0;
    hand_pulse_ = {};
  }
  if (injection_ != InjectionState::kInject) pulse_by_hand_ = false;
  if (event == InjectionEvent::kLost || event == InjectionEvent::kOut) monitor_.rearm();
  if (event == InjectionEvent::kReset) monitor_.reset();
}

void InjectionController::takeHold(const Eigen::Vector3d& needle) {
  setpoint_ = needle;
  home_ = needle;
  needle_speed_.reset();
  if (config_.mode == "automatic" && config_.start_when_enabled && state_ == OperatingState::kEnabled)
    start(config_.goal);
}

std::optional<Eigen::Vector3d> InjectionController::step(const Input& input, double dt) {
  needle_known_ = needle_known_ || trusted(input.needle);
  if (state_ == OperatingState::kDisabled || state_ == OperatingState::kFault) return std::nullopt;
  if (!trusted(input.needle)) {
    held_because_ = "no trusted needle position";
    target_offset_.reset();
    monitor_.skip();
    needle_speed_.reset();
    endPulse(held_because_);
    return setpoint_;  // before the first pose there is nothing to hold yet
  }
  if (!setpoint_) takeHold(*input.needle);
  if (rigIsAtFault(*input.needle, dt)) return std::nullopt;
  observe(input, trusted(input.force), dt);
  if (state_ == OperatingState::kPaused) return setpoint_;
  if (homing_) {
    goHome(input.axis, dt);
    return setpoint_;
  }
  const auto target = byHand() ? handTarget(input) : ownTarget(input, dt);
  if (target && byHand()) follow(*target, input, dt);
  if (target && !byHand()) move(*target - *setpoint_, dt);
  return setpoint_;
}

bool InjectionController::rigIsAtFault(const Eigen::Vector3d& needle, double dt) {
  const std::string fault = rigFault(config_.guards, needle, *setpoint_, needle_speed_.step(needle, dt));
  if (fault.empty()) return false;
  held_because_ = fault;
  state_ = OperatingState::kFault;
  run_.end(InjectionOutcome::kFault, fault);
  happen(InjectionEvent::kFail);
  return true;
}

void InjectionController::observe(const Input& input, bool force_trusted, double dt) {
  if (force_trusted) {
    monitor_.step(*input.needle, input.axis, *input.force);
  } else {
    monitor_.skip();
  }
  if (!byHand()) return;
  if (pulse_by_hand_ && hand_pulse_.step(input.injector, dt) != InjectorWait::Status::kWaiting) {
    happen(InjectionEvent::kInjected);
  }
  if (!force_trusted) return;
  const auto event = observer_.step(injection_, monitor_, pulse_by_hand_ ? std::nullopt : input.injector);
  if (event) happen(*event);
}

std::optional<Eigen::Vector3d> InjectionController::handTarget(const Input& input) {
  held_because_.clear();
  if (!trusted(input.target)) held_because_ = "no trusted target";
  if (!trusted(input.force)) held_because_ = "no trusted force";
  if (!held_because_.empty()) {
    target_offset_.reset();
    return std::nullopt;
  }
  // The hand may have gone anywhere while the needle was held: the target counts from where it is now.
  if (!target_offset_) target_offset_ = *setpoint_ - *input.target;
  return *input.target + *target_offset_;
}

std::string InjectionController::guard(const Input& input) const {
  std::string reason = forceGuard(config_.guards, *input.force, input.axis);
  if (reason.empty()) reason = depthGuard(config_.guards, monitor_.depth());
  return reason;
}

void InjectionController::stop(InjectionOutcome outcome, const std::string& reason) {
  run_.end(outcome, reason);
  state_ = OperatingState::kPaused;
  held_because_ = reason;
}

/// Where it is not known what is injected into. By hand only the pulse is over.
void InjectionController::endPulse(const std::string& why) {
  if (!pulse()) return;
  if (byHand()) return happen(InjectionEvent::kInjected);
  stop(InjectionOutcome::kGuard, why + " while it injects");
}

std::optional<Eigen::Vector3d> InjectionController::ownTarget(const Input& input, double dt) {
  const bool out = injection_ == InjectionState::kWithdraw;
  held_because_.clear();
  if (!run_.active() && !out) {
    held_because_ = "no injection is under way";
    return std::nullopt;
  }
  if (!out && !trusted(input.force)) {
    held_because_ = "no trusted force";
    // What the membrane does meanwhile is not known.
    if (injection_ == InjectionState::kIndent) stop(InjectionOutcome::kGuard, "no trusted force while it indents");
    endPulse(held_because_);
    return std::nullopt;
  }
  const std::string beyond = out ? "" : guard(input);
  if (!beyond.empty()) {
    stop(InjectionOutcome::kGuard, beyond);
    return std::nullopt;
  }
  const InjectionRun::Step step = run_.step(injection_, monitor_, input.injector, *setpoint_, input.axis, dt);
  if (step.event) happen(*step.event);
  if (!step.stop) return step.target;
  stop(*step.stop, step.reason);
  return std::nullopt;
}

void InjectionController::goHome(const Eigen::Vector3d& axis, double dt) {
  held_because_ = "homing";
  const Eigen::Vector3d way = home_ - *setpoint_;
  const double out = way.dot(axis);
  // First out of the cell along the pipette, then across, for a needle that goes sideways tears; never deeper.
  move(out > 1e-9 ? Eigen::Vector3d(out * axis) : Eigen::Vector3d(way - out * axis), dt);
  const Eigen::Vector3d left = home_ - *setpoint_;
  if (std::max(0.0, left.dot(axis)) + (left - left.dot(axis) * axis).norm() > 1e-9) return;
  homing_ = false;
  state_ = OperatingState::kPaused;
  held_because_ = "PAUSED";
  if (!byHand()) happen(InjectionEvent::kOut);
}

void InjectionController::follow(const Eigen::Vector3d& target, const Input& input, double dt) {
  Eigen::Vector3d motion = target - *setpoint_;
  if (motion.norm() > config_.guards.jump_limit) {
    std::ostringstream text;
    text << "target is " << motion.norm() << " m away, allowed " << config_.guards.jump_limit
         << " m; press the clutch to take hold afresh";
    held_because_ = text.str();
    return;
  }
  const std::string beyond = guard(input);
  if (!beyond.empty()) {
    held_because_ = beyond + ": the needle may only be withdrawn";
    motion = input.axis * std::max(0.0, motion.dot(input.axis));
    // What was refused is forgotten: when the force falls, as in a puncture, the needle must not catch up with it.
    if (target_offset_) *target_offset_ += *setpoint_ + motion - target;
  }
  move(motion, dt);
}

void InjectionController::move(const Eigen::Vector3d& motion, double dt) {
  const double largest = std::min(config_.guards.speed_limit, rig_speed_) * dt;
  *setpoint_ += motion.norm() > largest ? Eigen::Vector3d(motion * (largest / motion.norm())) : motion;
}

}  // namespace microinjection
