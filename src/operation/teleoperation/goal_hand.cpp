#include "operation/teleoperation/goal_hand.h"

#include "base/vectors.h"

namespace microinjection {

GoalHandConfig GoalHandConfig::read(ConfigReader& reader) {
  GoalHandConfig config;
  reader.number("hand_speed", config.speed, Range::positive());
  reader.number("present_timeout", config.present_timeout, Range::positive());
  return config;
}

void GoalHand::moveBy(const Eigen::Vector3d& step) {
  moveTo(position_ + clampedNorm(goal_ + step - position_, config_.lead));
  stay();
}

void GoalHand::moveTo(const Eigen::Vector3d& goal) { goal_ = goal; }

void GoalHand::release() {
  time_since_input_ = config_.present_timeout;
  goal_ = position_;
}

const Eigen::Vector3d& GoalHand::step(double dt) {
  time_since_input_ += dt;
  if (!present()) {
    goal_ = position_;
    return position_;
  }
  position_ += clampedNorm(goal_ - position_, config_.speed * dt);
  return position_;
}

}  // namespace microinjection
