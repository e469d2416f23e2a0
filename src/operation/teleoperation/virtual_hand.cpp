#include "operation/teleoperation/virtual_hand.h"

namespace microinjection {

VirtualHandConfig VirtualHandConfig::read(ConfigReader& reader) {
  VirtualHandConfig config;
  reader.number("mass", config.mass, Range::positive());
  reader.number("damping", config.damping, Range::nonNegative());
  reader.number("stiffness", config.stiffness, Range::positive());
  return config;
}

const Eigen::Vector3d& VirtualHand::step(const Eigen::Vector3d& meant, const Eigen::Vector3d& force, double dt) {
  // Implicit Euler: stable for every mass, damping, stiffness and step, also after the machine has stalled.
  const Eigen::Vector3d meant_velocity = (meant - intended_) / dt;
  const double c = config_.damping, k = config_.stiffness;
  const Eigen::Vector3d pull = config_.mass / dt * velocity_ + k * (meant - position_) + c * meant_velocity + force;
  velocity_ = pull / (config_.mass / dt + c + k * dt);
  position_ += dt * velocity_;
  intended_ = meant;
  return position_;
}

}  // namespace microinjection
