#include "control/injection_controller.h"

#include <algorithm>
#include <sstream>

namespace microinjection {
namespace {

bool trusted(const std::optional<Eigen::Vector3d>& value) { return value && value->allFinite(); }

}  // namespace

InjectionControllerConfig InjectionControllerConfig::read(ConfigReader& reader) {
  InjectionControllerConfig config;
  reader.choice("source", config.source, {"teleop", "approach"});
  reader.number("speed_limit", config.speed_limit, Range::positive());
  reader.number("jump_limit", config.jump_limit, Range::positive());
  reader.number("tracking_limit", config.tracking_limit, Range::positive());
  reader.number("force_limit", config.force_limit, Range::positive());
  ConfigReader approach = reader.section("approach");
  config.approach = ApproachConfig::read(approach);
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
    : config_(config), approach_(config.approach) {}

bool InjectionController::busy() const {
  return state_ == OperatingState::kEnabled && (homing_ || (config_.source == "approach" && !approach_.done()));
}

std::string InjectionController::command(const std::string& command) {
  const std::string refusal = std::string("state is ") + toText(state_) + ", ";
  if (command == "disable") {
    state_ = OperatingState::kDisabled;
    held_because_ = "DISABLED";
    setpoint_.reset();
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
  } else {
    return "\"" + command + "\" is no command here; allowed: enable, disable, pause, resume, home";
  }
  homing_ = command == "home";
  if (homing_) approach_.end();
  target_offset_.reset();
  return "";
}

std::optional<Eigen::Vector3d> InjectionController::step(const Input& input, double dt) {
  needle_known_ = needle_known_ || trusted(input.needle);
  if (state_ == OperatingState::kDisabled || state_ == OperatingState::kFault) return std::nullopt;
  if (!trusted(input.needle)) {
    held_because_ = "no trusted needle position";
    target_offset_.reset();
    return setpoint_;  // before the first pose there is nothing to hold yet
  }
  if (!setpoint_) {
    setpoint_ = input.needle;
    home_ = *setpoint_;
    approach_.start(*setpoint_);
  }
  if (needleIsLost(*input.needle)) return std::nullopt;
  if (state_ == OperatingState::kPaused) return setpoint_;
  if (homing_) {
    goHome(input.axis, dt);
    return setpoint_;
  }
  if (const auto target = wanted(input, dt)) follow(*target, input, dt);
  return setpoint_;
}

bool InjectionController::needleIsLost(const Eigen::Vector3d& needle) {
  const double error = (needle - *setpoint_).norm();
  if (error <= config_.tracking_limit) return false;
  std::ostringstream text;
  text << "the needle is " << error << " m from its set-point, allowed " << config_.tracking_limit << " m";
  held_because_ = text.str();
  state_ = OperatingState::kFault;
  return true;
}

std::optional<Eigen::Vector3d> InjectionController::wanted(const Input& input, double dt) {
  const bool own = config_.source == "approach";
  held_because_.clear();
  if (!own && !trusted(input.target)) held_because_ = "no trusted target";
  if (!trusted(input.force)) held_because_ = "no trusted force";
  if (!held_because_.empty()) {
    target_offset_.reset();
    return std::nullopt;
  }
  if (own) return approachTarget(input, dt);
  // The hand may have gone anywhere while the needle was held: the target counts from where it is now.
  if (!target_offset_) target_offset_ = *setpoint_ - *input.target;
  return *input.target + *target_offset_;
}

std::optional<Eigen::Vector3d> InjectionController::approachTarget(const Input& input, double dt) {
  if (approach_.done()) {
    held_because_ = "the approach is over";
    return std::nullopt;
  }
  if (input.force->norm() > config_.force_limit) approach_.withdraw();
  return approach_.step(input.axis, *input.force, dt);
}

void InjectionController::goHome(const Eigen::Vector3d& axis, double dt) {
  held_because_ = "homing";
  const Eigen::Vector3d way = home_ - *setpoint_;
  const double out = way.dot(axis);
  // First out of the cell along the pipette, then across, for a needle that goes sideways tears; never deeper.
  const Eigen::Vector3d motion = out > 1e-9 ? Eigen::Vector3d(out * axis) : Eigen::Vector3d(way - out * axis);
  const double largest = std::min(config_.speed_limit, rig_speed_) * dt;
  *setpoint_ += motion.norm() > largest ? Eigen::Vector3d(motion * (largest / motion.norm())) : motion;
  const Eigen::Vector3d left = home_ - *setpoint_;
  if (std::max(0.0, left.dot(axis)) + (left - left.dot(axis) * axis).norm() > 1e-9) return;
  homing_ = false;
  state_ = OperatingState::kPaused;
  held_because_ = "PAUSED";
}

void InjectionController::follow(const Eigen::Vector3d& target, const Input& input, double dt) {
  Eigen::Vector3d motion = target - *setpoint_;
  if (motion.norm() > config_.jump_limit) {
    std::ostringstream text;
    text << "target is " << motion.norm() << " m away, allowed " << config_.jump_limit
         << " m; press the clutch to take hold afresh";
    held_because_ = text.str();
    return;
  }
  if (input.force->norm() > config_.force_limit) {
    held_because_ = "force limit reached: the needle may only be withdrawn";
    motion = input.axis * std::max(0.0, motion.dot(input.axis));
    // What was refused is forgotten: when the force falls, as in a puncture, the needle must not catch up with it.
    if (target_offset_) *target_offset_ += *setpoint_ + motion - target;
  }
  const double largest = std::min(config_.speed_limit, rig_speed_) * dt;
  if (motion.norm() > largest) motion *= largest / motion.norm();
  *setpoint_ += motion;
}

}  // namespace microinjection
