#include "teleoperation/haptic_bridge.h"

#include <algorithm>

namespace microinjection {
namespace {

bool trusted(const std::optional<Eigen::Vector3d>& value) { return value && value->allFinite(); }

std::string whyHeld(const HapticBridge::Input& input) {
  if (!trusted(input.hand)) return "no trusted hand position";
  if (!trusted(input.needle)) return "no trusted needle position";
  if (!trusted(input.force)) return "no trusted force";
  return input.clutch ? "clutch is pressed" : "";
}

}  // namespace

HapticBridgeConfig HapticBridgeConfig::read(ConfigReader& reader) {
  HapticBridgeConfig config;
  reader.number("position_scale", config.position_scale, Range::positive());
  reader.number("force_gain", config.force_gain, Range::nonNegative());
  reader.number("force_limit", config.force_limit, Range::positive());
  reader.number("ramp_time", config.ramp_time, Range::nonNegative());
  return config;
}

Eigen::Vector3d HapticBridge::render(const Eigen::Vector3d& tip_force, double dt) {
  ramp_ = config_.ramp_time > 0 ? std::min(1.0, ramp_ + dt / config_.ramp_time) : 1.0;
  const Eigen::Vector3d force = ramp_ * config_.force_gain * tip_force;
  const double size = force.norm();
  return size > config_.force_limit ? Eigen::Vector3d(force * (config_.force_limit / size)) : force;
}

HapticBridge::Output HapticBridge::step(const Input& input, double dt) {
  Output output;
  output.held_because = whyHeld(input);
  if (!output.held_because.empty()) {
    engaged_ = false;
    ramp_ = 0;
    return output;
  }
  if (!engaged_) {
    hand_initial_ = *input.hand;
    needle_initial_ = *input.needle;
    engaged_ = true;
  }
  output.needle = needle_initial_ + config_.position_scale * (*input.hand - hand_initial_);
  output.hand_force = render(*input.force, dt);
  return output;
}

}  // namespace microinjection
