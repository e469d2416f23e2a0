#include "teleoperation/motion_mapping.h"

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

void MotionMapping::anchor(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle) {
  hand_ = hand;
  needle_ = target_ = needle;
}

const Eigen::Vector3d& MotionMapping::step(const Eigen::Vector3d& hand, double dt) {
  const Eigen::Vector3d deflection = hand - hand_;
  if (!isRate()) {
    target_ = needle_ + config_.position_scale * deflection;
    return target_;
  }
  const double size = deflection.norm();
  if (size <= config_.dead_zone) return target_;
  const double speed = std::min(config_.rate_limit, config_.rate_gain * (size - config_.dead_zone));
  target_ += speed * dt / size * deflection;
  return target_;
}

double MotionMapping::disagreement(const Eigen::Vector3d& hand, const Eigen::Vector3d& needle) const {
  const Eigen::Vector3d deflection = hand - hand_;
  if (isRate()) return std::max(0.0, deflection.norm() - config_.dead_zone);
  return (deflection - (needle - needle_) / config_.position_scale).norm();
}

}  // namespace microinjection
