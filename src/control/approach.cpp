#include "control/approach.h"

#include <algorithm>

namespace microinjection {

ApproachConfig ApproachConfig::read(ConfigReader& reader) {
  ApproachConfig config;
  reader.number("approach_speed", config.approach_speed, Range::positive());
  reader.number("contact_force", config.contact_force, Range::positive());
  reader.number("travel_limit", config.travel_limit, Range::positive());
  reader.number("depth", config.depth, Range::positive());
  reader.number("indent_speed", config.indent_speed, Range::positive());
  reader.number("hold_time", config.hold_time, Range::nonNegative());
  reader.number("retract_speed", config.retract_speed, Range::positive());
  return config;
}

void Approach::start(const Eigen::Vector3d& start) {
  start_ = start;
  travel_ = held_ = 0;
  touched_ = false;
  phase_ = Phase::kApproach;
}

void Approach::withdraw() {
  if (phase_ != Phase::kDone) phase_ = Phase::kRetract;
}

Eigen::Vector3d Approach::step(const Eigen::Vector3d& axis, const Eigen::Vector3d& force, double dt) {
  switch (phase_) {
    case Phase::kApproach:
      travel_ = std::min(config_.travel_limit, travel_ + config_.approach_speed * dt);
      touched_ = force.dot(axis) >= config_.contact_force;
      touch_travel_ = travel_;
      if (touched_) phase_ = Phase::kIndent;
      if (!touched_ && travel_ >= config_.travel_limit) phase_ = Phase::kRetract;
      break;
    case Phase::kIndent:
      travel_ = std::min(touch_travel_ + config_.depth, travel_ + config_.indent_speed * dt);
      if (travel_ >= touch_travel_ + config_.depth) phase_ = Phase::kHold;
      break;
    case Phase::kHold:
      held_ += dt;
      if (held_ >= config_.hold_time) phase_ = Phase::kRetract;
      break;
    case Phase::kRetract:
      travel_ = std::max(0.0, travel_ - config_.retract_speed * dt);
      if (travel_ <= 0) phase_ = Phase::kDone;
      break;
    case Phase::kDone:
      break;
  }
  return start_ - travel_ * axis;
}

}  // namespace microinjection
