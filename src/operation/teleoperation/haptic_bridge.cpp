#include "operation/teleoperation/haptic_bridge.h"

#include <algorithm>

#include "base/vectors.h"

namespace microinjection {

HapticBridgeConfig HapticBridgeConfig::read(ConfigReader& reader) {
  HapticBridgeConfig config;
  reader.number("force_gain", config.force_gain, Range::nonNegative());
  reader.number("ramp_time", config.ramp_time, Range::nonNegative());
  reader.boolean("require_operator", config.require_operator);
  config.frame = FrameMappingConfig::read(reader);
  config.motion = MotionMappingConfig::read(reader);
  config.engagement = EngagementConfig::read(reader.section("engagement"));
  config.tremor = TremorFilterConfig::read(reader.section("tremor_filter"));
  config.fixtures = VirtualFixturesConfig::read(reader.section("fixtures"));
  config.force = ForceSourceConfig::read(reader);
  config.limits = ForceLimits::read(reader);
  config.coupling = VirtualCouplingConfig::read(reader.section("coupling"));
  config.passivity = PassivityConfig::read(reader.section("passivity"));
  return config;
}

HapticBridgeConfig HapticBridgeConfig::beforeLink() const {
  HapticBridgeConfig config = *this;
  config.coupling.enabled = false;
  config.coupling.lateness = 0;
  config.passivity.behind_channel = true;
  return config;
}

HapticBridge::HapticBridge(const HapticBridgeConfig& config)
    : config_(config),
      frame_(config.frame),
      tremor_(config.tremor),
      motion_(config.motion),
      engagement_(config.engagement),
      fixtures_(config.fixtures, config.motion.position_scale),
      coupling_(config.coupling),
      passivity_(config.passivity),
      limiter_(config.limits) {}

std::string HapticBridge::holdReason(const Input& input, const std::optional<Eigen::Vector3d>& force) const {
  if (!isValid(input.hand)) return "no valid hand position";
  if (!input.no_motion_reason.empty()) return input.no_motion_reason;
  if (!input.no_force_reason.empty()) return input.no_force_reason;
  if (!isValid(input.needle)) return "no valid needle position";
  if (!force) return "no valid force";
  if (config_.require_operator && !input.operator_present) return "the operator is not present";
  return input.clutch ? "clutch is pressed" : "";
}

void HapticBridge::begin(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle, const Eigen::Vector3d& force) {
  motion_.setReference(hand, needle);
  tremor_.reset(hand);
  coupling_.reset(force);
  proxy_offset_start_ = coupling_.proxyOffset();
  ramp_ = 0;
}

Eigen::Vector3d HapticBridge::render(const Eigen::Vector3d& wanted, double dt) {
  const Eigen::Vector3d& force = limiter_.step(wanted, passivity_.velocity(), dt);
  passivity_.setRendered(force);
  return frame_.toDevice(force);
}

HapticBridge::Output HapticBridge::step(const Input& input, double dt) {
  const std::optional<Eigen::Vector3d> tip_force = chooseForce(config_.force, input.force);
  Output output;
  output.hold_reason = holdReason(input, tip_force);
  if (!isValid(input.hand)) {
    engagement_.step({true, input.clutch});
    limiter_.release();
    passivity_.reset();
    return output;
  }
  const Eigen::Vector3d hand = frame_.toWorld(*input.hand);
  const bool followed = engagement_.state() == Engagement::State::kFollow;
  if (!followed) passivity_.pause();
  passivity_.observe(hand, dt);

  const bool held = !output.hold_reason.empty();
  const bool interrupted = held && input.no_force_reason.empty() && input.no_motion_reason.empty() && !input.clutch &&
                           (!config_.require_operator || input.operator_present);
  const double speed = motion_.isRate() ? 0 : passivity_.velocity().norm();  // a released stick springs back fast
  output.state = engagement_.step({held, input.clutch, speed, held ? 0 : motion_.misalignment(hand, *input.needle),
                                   interrupted, dt, motion_.isAtRest(hand), input.hand_leaps && !motion_.isRate()});
  if (output.state != Engagement::State::kFollow) {
    if (!held) output.hold_reason = engagement_.reason();
    output.hand_force = render(Eigen::Vector3d::Zero(), dt);
    return output;
  }

  const Eigen::Vector3d contact_force = config_.force_gain * *tip_force;
  if (!followed) begin(hand, *input.needle, contact_force);
  ramp_ = config_.ramp_time > 0 ? std::min(1.0, ramp_ + dt / config_.ramp_time) : 1.0;
  // In rate mode there is no proxy that could yield. The first target is exactly the needle's
  // position.
  const bool yields = followed && !motion_.isRate();
  const Eigen::Vector3d proxy_offset =
      yields ? Eigen::Vector3d(coupling_.step(contact_force, dt) - proxy_offset_start_) : Eigen::Vector3d::Zero();
  const VirtualFixtures::Result fixed = fixtures_.apply(motion_.step(tremor_.step(hand, dt) + proxy_offset, dt));
  motion_.limitTo(fixed.target);
  output.needle = fixed.target;
  const Eigen::Vector3d total_force = contact_force + fixed.hand_force;
  const Eigen::Vector3d damped_force =
      total_force - coupling_.contactDamping(passivity_.stiffness()) * passivity_.velocity();
  output.hand_force = render(passivity_.control(ramp_ * damped_force, total_force, dt), dt);
  return output;
}

}  // namespace microinjection
