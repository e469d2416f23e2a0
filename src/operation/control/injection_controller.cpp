#include "operation/control/injection_controller.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "base/vectors.h"

namespace microinjection {
namespace {

constexpr double kOut = 1e-6;  ///< m before the contact point, from where on a needle is out of the cell

// Abilities beyond these are a mistake: the fastest micromanipulators reach some 0.02 m/s, and the
// slowest serial line takes a fraction of a second for a command.
constexpr double kSlowestRig = 1e-6;  ///< m/s: a slower one would hold the needle without a report
constexpr double kFastestRig = 1;     ///< m/s
constexpr double kLatestRig = 10;     ///< s

}  // namespace

InjectionController::InjectionController(const InjectionControllerConfig& config)
    : config_(config),
      monitor_(config.detection),
      witness_(config.detection, config.witness),
      withdrawal_(config.guards),
      run_(config.motion, config.guards, config.expectation, config.break_detection, config.mode == "automatic"),
      holding_(config.holding),
      following_error_limit_(followingErrorLimit(config.guards, std::numeric_limits<double>::infinity())) {}

std::string InjectionController::adaptTo(double speed, double lag) {
  const Range speeds = Range::closed(kSlowestRig, kFastestRig), lags = Range::closed(0, kLatestRig);
  std::ostringstream refusal;
  if (!speeds.contains(speed)) {
    refusal << "speed = " << speed << " m/s, allowed " << speeds.text() << " m/s";
  } else if (!lags.contains(lag)) {
    refusal << "lag = " << lag << " s, allowed " << lags.text() << " s";
  }
  if (refusal.tellp() > 0) return refusal.str();
  rig_speed_ = std::min(speed, lag > 0 ? config_.guards.lag_limit / lag : speed);
  following_error_limit_ = followingErrorLimit(config_.guards, lag);
  run_.limitSpeed(rig_speed_);
  return "";
}

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

void InjectionController::apply(InjectionEvent event) {
  const auto next = after(injection_, event);
  if (!next) return;
  injection_ = *next;
  if (event == InjectionEvent::kPuncture) ++punctures_;
  if (event == InjectionEvent::kStart) {
    punctures_ = 0;
    hand_pulse_ = {};
  }
  if (injection_ != InjectionState::kInject) {
    if (pulse_by_hand_ && event == InjectionEvent::kFail) notice_ = "the pulse was ended: " + hold_reason_;
    if (pulse_by_hand_ && event == InjectionEvent::kWithdraw) notice_ = "the pulse was ended: the needle is withdrawn";
    pulse_by_hand_ = false;
  }
  if (event == InjectionEvent::kLost || event == InjectionEvent::kOut) {
    monitor_.rearm();
    witness_.rearm();
  }
  if (event == InjectionEvent::kOut && paused_) hold("PAUSED");
}

bool InjectionController::isInside(const Eigen::Vector3d& needle, const Eigen::Vector3d& axis) const {
  return monitor_.touched() && monitor_.depthOf(needle, axis) > -kOut;
}

void InjectionController::engage(const Eigen::Vector3d& needle, const Eigen::Vector3d& axis) {
  setpoint_ = needle;
  needle_speed_.reset();
  withdrawal_.reset();
  // In the cell, home, the contact point and the force at rest stay.
  if (isInside(needle, axis)) return;
  resetMonitors();
  home_ = needle;
  if (config_.mode == "automatic" && config_.start_when_enabled && state_ == OperatingState::kEnabled)
    start(config_.goal);
}

/// A force that cannot be is none. Its cause does not go away by itself: a person has to look at the sensor.
void InjectionController::refuseForce(Input& input) {
  const bool sensor = !config_.witness.measured;
  // A force that was felt well before the model's touch is of a cell that is not where its model is.
  const bool comparable = monitor_.depth() - witness_.depth() <= config_.witness.depth;
  const std::optional<Eigen::Vector3d> predicted = comparable ? input.witness : std::nullopt;
  sensor_fault_ =
      isValid(input.force) && sensor ? sensorFault(config_.guards, *input.force, input.axis, predicted) : "";
  if (sensor_fault_.empty()) return;
  input.force.reset();
  const bool withdraws = homing_ || injection_ == InjectionState::kWithdraw || needleWaits(injection_);
  if (state_ != OperatingState::kEnabled || withdraws) return;
  endPulse(sensor_fault_);
  run_.end(InjectionOutcome::kGuard, sensor_fault_);
  hold(sensor_fault_);
  if (setpoint_ && isValid(input.needle)) stopNeedle(input);
}

std::optional<Eigen::Vector3d> InjectionController::step(Input input, double dt) {
  const bool needle_valid = isValid(input.needle);
  needle_valid_ = needle_valid_ || needle_valid;
  if (needle_valid && isValid(input.force)) guard_force_ = input.force->dot(input.axis);
  if (config_.holder) watchHold(input, dt);
  refuseForce(input);
  if (state_ == OperatingState::kDisabled || state_ == OperatingState::kFault) {
    // Something else may have moved the needle out of the cell.
    if (needle_valid && monitor_.touched() && !isInside(*input.needle, input.axis)) resetMonitors();
    return std::nullopt;
  }
  if (!needle_valid) {
    invalidateNeedle(dt);
    return setpoint_;  // empty before the first pose
  }
  if (!input.rig_hold.empty()) {
    yieldToRig(input);
    return setpoint_;
  }
  yielded_.reset();
  if (!setpoint_) engage(*input.needle, input.axis);
  if (rigIsAtFault(*input.needle, dt)) return std::nullopt;
  observe(input, isValid(input.force), dt);
  if (state_ == OperatingState::kPaused) {
    monitorPulse(input, dt);
  } else if (homing_) {
    stepHome(input, dt);
  } else if (unhomed_ && injection_ != InjectionState::kWithdraw) {
    holdUnhomed();
  } else if (byHand()) {
    if (const auto target = handTarget(input)) follow(*target, input, dt);
  } else if (const auto target = ownTarget(input, dt)) {
    move(*target - *setpoint_, input, dt);
  }
  return setpoint_;
}

void InjectionController::invalidateNeedle(double dt) {
  hold_reason_ = "no valid needle position";
  target_offset_.reset();
  monitor_.skip();
  witness_.forgetPairs();
  needle_speed_.reset();
  endPulse(hold_reason_);
  if (byHand() || !run_.active() || state_ != OperatingState::kEnabled) return;
  if (const char* work = blindWork()) stop(InjectionOutcome::kGuard, hold_reason_ + " while it " + work);
  const std::string late = run_.wait(injection_, dt);
  if (!late.empty()) stop(InjectionOutcome::kGuard, late);
}

/// While the rig does not follow, the set-point is where the needle is: nothing leaps when it does again.
void InjectionController::yieldToRig(const Input& input) {
  if (!yielded_) yielded_ = input.needle;
  if (setpoint_) setpoint_ = input.needle;
  target_offset_.reset();
  needle_speed_.reset();
  monitor_.skip();
  witness_.forgetPairs();
  endPulse(input.rig_hold);
  const bool moved = (*input.needle - *yielded_).norm() > following_error_limit_;
  if (run_.active() && moved) stop(InjectionOutcome::kGuard, input.rig_hold + ", and the needle was moved meanwhile");
  if (state_ == OperatingState::kPaused) return;
  hold_reason_ = input.rig_hold;
  if (busy()) hold(input.rig_hold);
}

bool InjectionController::rigIsAtFault(const Eigen::Vector3d& needle, double dt) {
  const std::string fault = rigFault(config_.guards, needle, *setpoint_, needle_speed_.step(needle, dt));
  if (fault.empty()) return false;
  hold_reason_ = fault;
  state_ = OperatingState::kFault;
  run_.end(InjectionOutcome::kFault, fault);
  apply(InjectionEvent::kFail);
  return true;
}

void InjectionController::watchHold(const Input& input, double dt) {
  const std::string before = holding_.loss(), failed = holding_.failure();
  holding_.step(input.holder, input.cell_hold, dt);
  const bool is_lost = byHand() && holding_.phase() == Holding::Phase::kHeld && !holding_.loss().empty();
  if (is_lost && holding_.loss() != before) notice_ = holding_.loss();
  if (holding_.failure() != failed && !holding_.failure().empty()) notice_ = holding_.failure();
}

void InjectionController::resetMonitors() {
  monitor_.reset();
  witness_.reset();
}

/// Why no pulse may begin; empty: no witness denies the puncture.
std::string InjectionController::contradiction() const {
  if (!witness_fault_.empty()) return witness_fault_;
  if (denies_puncture_) return "the force fell, but the cell whose force is predicted is not punctured";
  return witness_.deniesPuncture();
}

std::string InjectionController::disagreement() const {
  return witness_fault_.empty() ? witness_.disagreement() : witness_fault_;
}

void InjectionController::observe(const Input& input, bool force_valid, double dt) {
  if (input.cell_changed) {
    monitor_.skip();
    witness_.skip();
  }
  denies_puncture_ = input.predicted_inside && !*input.predicted_inside;
  predicted_inside_ = input.predicted_inside.value_or(false);
  witness_fault_ = input.witness_fault;
  witness_.step(*input.needle, input.axis, input.witness, input.witness_is_new);
  if (!force_valid) {
    monitor_.skip();
    witness_.forgetPairs();
  } else if (input.force_is_new) {
    monitor_.step(*input.needle, input.axis, *input.force);
  } else {
    monitor_.move(*input.needle, input.axis);
  }
  if (force_valid) witness_.compare(monitor_, *input.force, input.force_is_new);
  witness_.see(monitor_, input.image, dt);
  if (!byHand()) return;
  monitorManualPulse(input, dt);
  if (!force_valid) return;
  const auto event = observer_.step(injection_, monitor_, pulse_by_hand_ ? std::nullopt : input.injector);
  if (event) apply(*event);
}

/// A pulse continues while the needle is PAUSED, up to its volume.
void InjectionController::monitorPulse(const Input& input, double dt) {
  if (!run_.active() || injection_ != InjectionState::kInject) return;
  if (!isValid(input.force)) return endPulse("no valid force");
  applyStep(run_.step(injection_, monitor_, input.injector, *setpoint_, input.axis, dt));
}

std::optional<Eigen::Vector3d> InjectionController::handTarget(const Input& input) {
  hold_reason_.clear();
  if (!isValid(input.target)) hold_reason_ = kNoTarget;
  if (!isValid(input.force)) hold_reason_ = "no valid force";
  if (!hold_reason_.empty()) {
    target_offset_.reset();
    if (!isValid(input.force)) endPulse(hold_reason_);
    return std::nullopt;
  }
  // The hand may have moved while the needle was held: its target counts from the present
  // set-point.
  if (!target_offset_) target_offset_ = *setpoint_ - *input.target;
  return *input.target + *target_offset_;
}

std::string InjectionController::guard(const Input& input) const {
  std::string reason = forceGuard(config_.guards, *input.force, input.axis);
  if (reason.empty()) reason = depthGuard(config_.guards, monitor_.depth());
  return reason;
}

void InjectionController::hold(const std::string& reason) {
  state_ = OperatingState::kPaused;
  hold_reason_ = reason;
}

void InjectionController::stop(InjectionOutcome outcome, const std::string& reason) {
  run_.end(outcome, reason);
  hold(reason);
}

/// Moves the set-point back to a lagging needle, which must not go deeper.
void InjectionController::stopNeedle(const Input& input) {
  const double ahead = (*input.needle - *setpoint_).dot(input.axis);
  *setpoint_ += std::max(0.0, ahead) * input.axis;
}

std::optional<Eigen::Vector3d> InjectionController::ownTarget(const Input& input, double dt) {
  const bool out = injection_ == InjectionState::kWithdraw;
  hold_reason_.clear();
  if (!run_.active() && !out) {
    hold_reason_ = "no injection is under way";
    return std::nullopt;
  }
  const bool needs_force = !out && !needleWaits(injection_);
  if (needs_force && !isValid(input.force)) {
    hold_reason_ = "no valid force";
    // Without a force a puncture would not be detected.
    if (const char* work = blindWork()) {
      stop(InjectionOutcome::kGuard, std::string("no valid force while it ") + work);
      stopNeedle(input);
    }
    endPulse(hold_reason_);
    return std::nullopt;
  }
  const std::string beyond = needs_force ? guard(input) : "";
  if (!beyond.empty()) {
    stop(InjectionOutcome::kGuard, beyond);
    stopNeedle(input);
    return std::nullopt;
  }
  run_.expect(input.expected);
  run_.see(input.interface);
  if (config_.holder) run_.see(holding_);
  InjectionRun::Step step = run_.step(injection_, monitor_, input.injector, *setpoint_, input.axis, dt);
  if (!step.stop) step.reason = !needs_force || run_.result().punctures > 0 ? "" : disagreement();
  if (step.event == InjectionEvent::kInject && step.reason.empty() && run_.goal().puncture)
    step.reason = contradiction();
  if (!step.stop && !step.reason.empty()) {
    step.event.reset();
    step.stop = InjectionOutcome::kGuard;
  }
  if (applyStep(step)) return step.target;
  stopNeedle(input);
  return std::nullopt;
}

/// Applies a step of the injection. Returns whether it continues.
bool InjectionController::applyStep(const InjectionRun::Step& step) {
  if (step.event) apply(*step.event);
  if (step.releases) holding_.release(run_.goal().holding);
  if (step.stop) stop(*step.stop, step.reason);
  return !step.stop;
}

void InjectionController::stepHome(const Input& input, double dt) {
  const Eigen::Vector3d& axis = input.axis;
  hold_reason_ = "homing";
  const Eigen::Vector3d displacement = home_ - *setpoint_;
  const double out = displacement.dot(axis);
  // First out of the cell along the pipette, then across: lateral motion in the cell would tear it.
  // Never deeper.
  move(out > 1e-9 ? Eigen::Vector3d(out * axis) : Eigen::Vector3d(displacement - out * axis), input, dt);
  const Eigen::Vector3d left = home_ - *setpoint_;
  if (std::max(0.0, left.dot(axis)) + (left - left.dot(axis) * axis).norm() > 1e-9) return;
  homing_ = unhomed_ = false;
  hold("PAUSED");
  if (byHand()) return;
  apply(InjectionEvent::kOut);
  monitor_.rearm();
  witness_.rearm();
}

void InjectionController::holdUnhomed() {
  hold_reason_ = kNotHomed;
  target_offset_.reset();
  endPulse(hold_reason_);
}

void InjectionController::follow(const Eigen::Vector3d& target, const Input& input, double dt) {
  Eigen::Vector3d motion = target - *setpoint_;
  if (motion.norm() > config_.guards.jump_limit) {
    std::ostringstream text;
    text << "target is " << motion.norm() << " m away, allowed " << config_.guards.jump_limit
         << " m; press and release the clutch";
    hold_reason_ = text.str();
    return;
  }
  const bool begins = withdrawal_.step(*input.force, input.axis, monitor_.depth(), dt);
  if (begins && withdrawal_.lags((*input.needle - *setpoint_).dot(input.axis))) stopNeedle(input);
  const Eigen::Vector3d wanted = target - *setpoint_;
  const double out = withdrawal_.followed(wanted.dot(input.axis));
  motion = withdrawal_.active() ? Eigen::Vector3d(out * input.axis)
                                : Eigen::Vector3d(wanted + (out - wanted.dot(input.axis)) * input.axis);
  // The refused motion is discarded: when the force falls, as in a puncture, the needle must not
  // catch up.
  refuse(wanted - motion);
  if (withdrawal_.active()) hold_reason_ = withdrawal_.reason() + ": the needle may only be withdrawn";
  const Eigen::Vector3d before = *setpoint_;
  if (!move(motion, input, dt)) refuse(motion);
  const std::string endless = withdrawal_.withdraw((*setpoint_ - before).dot(input.axis));
  if (endless.empty()) return;
  endPulse(endless);
  hold(endless);
}

void InjectionController::refuse(const Eigen::Vector3d& motion) {
  if (target_offset_) *target_offset_ -= motion;
}

bool InjectionController::move(const Eigen::Vector3d& motion, const Input& input, double dt) {
  const double largest = std::min(config_.guards.speed_limit, rig_speed_) * dt;
  const Eigen::Vector3d next = *setpoint_ + clampedNorm(motion, largest);
  const double ahead = (next - *input.needle).norm();
  if (ahead > following_error_limit_ && ahead > (*setpoint_ - *input.needle).norm()) {
    hold_reason_ = "the needle does not follow its set-point";
    return false;
  }
  *setpoint_ = next;
  return true;
}

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
  ConfigReader expectation = reader.section("expected_puncture");
  config.expectation.read(expectation);
  ConfigReader witness = reader.section("witness");
  config.witness.read(witness);
  ConfigReader breaks = reader.section("break_detection");
  config.break_detection = BreakDetectionConfig::read(breaks);
  reader.boolean("holder", config.holder);
  ConfigReader holding = reader.section("holding");
  config.holding = HoldingConfig::read(holding);
  ConfigReader goal = reader.section("goal");
  config.goal = InjectionGoal::read(goal);
  if (config.holding.rest >= config.goal.holding.time) holding.error("rest", "must be below goal/holding/time");
  if (config.goal.depth > config.guards.depth_limit) goal.error("depth", "must not be above depth_limit");
  if (config.goal.break_by != BreakBy::kForce && config.goal.suction.dent > config.goal.depth)
    goal.error("suction/dent", "must not be above depth");
  return config;
}

std::string InjectionController::command(const std::string& command) {
  std::string refusal = execute(command);
  notice_ = refusal.empty() ? "" : command + " refused: " + refusal;
  return refusal;
}

std::string InjectionController::execute(const std::string& command) {
  if (command == "approach") {
    const bool next = injection_ == InjectionState::kHold;
    return next ? applyOperatorCommand(InjectionEvent::kStart) : start(config_.goal);
  }
  if (command == "hold") return holdCell();
  if (command == "release") return releaseCell();
  if (command == "indent") return applyOperatorCommand(InjectionEvent::kIndent);
  if (command == "aspirate") return applyOperatorCommand(InjectionEvent::kAspirate);
  if (command == "inject") return applyOperatorCommand(InjectionEvent::kInject);
  if (command == "withdraw") return withdraw();
  return applyCommand(command);
}

std::string InjectionController::applyCommand(const std::string& text) {
  const auto command = stateCommandOf(text);
  if (!command) {
    return "\"" + text +
           "\" is no command here; allowed: enable, disable, pause, resume, home, unhome, hold, approach, indent, "
           "aspirate, inject, withdraw, release";
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
      run_.restart();
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
  const bool holds = goal.holding.suction > 0;
  if ((holds || goal.holding.release) && !config_.holder)
    return "the goal holds or releases the cell, and no holder is there";
  if (holding_.phase() == Holding::Phase::kReleasing) return "the holding pipette lets the cell go";
  run_.start(goal, *setpoint_);
  resetMonitors();
  if (holds) holding_.take(goal.holding);
  apply(holds ? InjectionEvent::kHold : InjectionEvent::kStart);
  return "";
}

std::string InjectionController::holdCell() {
  if (!config_.holder) return "there is no holder";
  if (config_.goal.holding.suction <= 0) return "the goal has no suction to hold with";
  if (!byHand()) return start(config_.goal);
  if (state_ != OperatingState::kEnabled)
    return std::string("state is ") + toText(state_) + ", it is allowed in ENABLED";
  holding_.take(config_.goal.holding);
  return "";
}

std::string InjectionController::releaseCell() {
  if (!config_.holder) return "there is no holder";
  if (injection_ == InjectionState::kRelease) return applyOperatorCommand(InjectionEvent::kRelease);
  if (state_ != OperatingState::kEnabled)
    return std::string("state is ") + toText(state_) + ", it is allowed in ENABLED";
  if ((!byHand() && injection_ != InjectionState::kIdle) || monitor_.touched() || predicted_inside_)
    return "the needle may be in the cell; a cell is let go in idle, with the needle out";
  holding_.release(config_.goal.holding);
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

/// What the needle does in which a break would not be noticed; null: nothing.
const char* InjectionController::blindWork() const {
  if (injection_ == InjectionState::kIndent) return "indents";
  return injection_ == InjectionState::kAspirate ? "aspirates" : nullptr;
}

std::optional<PulseGoal> InjectionController::pulse() const {
  if (injection_ == InjectionState::kAspirate && state_ == OperatingState::kEnabled && run_.active()) {
    const std::optional<double> pressure = run_.suctionPressure();
    return pressure ? std::optional(PulseGoal{*pressure, InjectionGoalLimits::kDuration, 0}) : std::nullopt;
  }
  if (injection_ != InjectionState::kInject) return std::nullopt;
  if (run_.active()) return run_.goal().pulse;
  return pulse_by_hand_ ? std::optional(config_.goal.pulse) : std::nullopt;
}

void InjectionController::monitorManualPulse(const Input& input, double dt) {
  if (!pulse_by_hand_) return;
  const InjectorWait::Status status = hand_pulse_.step(input.injector, dt);
  if (status == InjectorWait::Status::kWaiting) return;
  if (status == InjectorWait::Status::kBroken) notice_ = "the injector ended the pulse too early";
  if (status == InjectorWait::Status::kRefused) notice_ = "the injector refused the pulse: " + input.injector->refusal;
  if (status == InjectorWait::Status::kTimeOut) notice_ = "the injector does not report the end of the pulse";
  apply(InjectionEvent::kInjected);
}

/// Ends a pulse whose target is unknown for lack of a valid input. By hand the injection itself
/// continues.
void InjectionController::endPulse(const std::string& reason) {
  if (!pulse()) return;
  if (byHand()) {
    notice_ = "the pulse was ended: " + reason;
    return apply(InjectionEvent::kInjected);
  }
  stop(InjectionOutcome::kGuard,
       reason + (injection_ == InjectionState::kInject ? " while it injects" : " while it aspirates"));
}

}  // namespace microinjection
