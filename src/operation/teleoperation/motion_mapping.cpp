#include "operation/teleoperation/motion_mapping.h"

#include <algorithm>

namespace microinjection {

MotionMappingConfig MotionMappingConfig::read(ConfigReader& reader) {
  MotionMappingConfig config;
  reader.choice("mode", config.mode, {"position", "rate"});
  reader.number("position_scale", config.position_scale, Range::positive());
  ConfigReader rate = reader.section("rate_mode");
  rate.number("gain", config.rate_gain, Range::positive());
  rate.number("dead_zone", config.dead_zone, Range::nonNegative());
  rate.number("speed_limit", config.rate_limit, Range::positive());
  return config;
}

void MotionMapping::setReference(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle) {
  hand_ = hand;
  needle_ = target_ = needle;
}

const Eigen::Vector3d& MotionMapping::step(const Eigen::Vector3d& hand, double dt) {
  if (!isRate()) {
    target_ = needle_ + config_.position_scale * (hand - hand_);
    return target_;
  }
  if (isAtRest(hand)) return target_;
  const double size = hand.norm();
  const double speed = std::min(config_.rate_limit, config_.rate_gain * (size - config_.dead_zone));
  target_ += speed * dt / size * hand;
  return target_;
}

double MotionMapping::misalignment(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle) const {
  return isRate() ? 0 : (hand - hand_ - (needle - needle_) / config_.position_scale).norm();
}

bool MotionMapping::isAtRest(const Eigen::Vector3d& hand) const {
  return !isRate() || hand.norm() <= config_.dead_zone;
}

}  // namespace microinjection
