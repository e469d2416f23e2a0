#include "operation/teleoperation/goal_hand.h"

namespace microinjection {

GoalHandConfig GoalHandConfig::read(ConfigReader& reader) {
  GoalHandConfig config;
  reader.number("hand_speed", config.speed, Range::positive());
  reader.number("present_timeout", config.present_timeout, Range::positive());
  return config;
}

void GoalHand::moveBy(const Eigen::Vector3d& step) {
  Eigen::Vector3d ahead = goal_ + step - position_;
  if (ahead.norm() > config_.lead) ahead *= config_.lead / ahead.norm();
  moveTo(position_ + ahead);
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
  const Eigen::Vector3d displacement = goal_ - position_;
  const double furthest = config_.speed * dt;
  position_ +=
      displacement.norm() > furthest ? Eigen::Vector3d(furthest / displacement.norm() * displacement) : displacement;
  return position_;
}

}  // namespace microinjection
