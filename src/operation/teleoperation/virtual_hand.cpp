#include "operation/teleoperation/virtual_hand.h"

namespace microinjection {

VirtualHandConfig VirtualHandConfig::read(ConfigReader& reader) {
  VirtualHandConfig config;
  reader.number("mass", config.mass, Range::positive());
  reader.number("damping", config.damping, Range::nonNegative());
  reader.number("stiffness", config.stiffness, Range::positive());
  return config;
}

const Eigen::Vector3d& VirtualHand::step(const Eigen::Vector3d& intended, const Eigen::Vector3d& force, double dt) {
  // Implicit Euler is stable for every mass, damping, stiffness and step, also after a stall of the
  // machine.
  const Eigen::Vector3d intended_velocity = (intended - last_intended_) / dt;
  const double c = config_.damping, k = config_.stiffness;
  const Eigen::Vector3d drive =
      config_.mass / dt * velocity_ + k * (intended - position_) + c * intended_velocity + force;
  velocity_ = drive / (config_.mass / dt + c + k * dt);
  position_ += dt * velocity_;
  last_intended_ = intended;
  return position_;
}

}  // namespace microinjection
