#include "operation/teleoperation/energy_gate.h"

#include <algorithm>

namespace microinjection {

EnergyGateConfig EnergyGateConfig::read(ConfigReader& reader) {
  EnergyGateConfig config;
  reader.number("damping_limit", config.damping_limit, Range::nonNegative());
  reader.number("velocity_floor", config.velocity_floor, Range::positive());
  reader.number("recovery_time", config.recovery_time, Range::positive());
  reader.number("return_time", config.return_time, Range::positive());
  reader.number("fade", config.fade, Range::nonNegative());
  reader.number("resolution", config.resolution, Range::positive());
  return config;
}

double EnergyGate::damping(double energy_deficit, const Eigen::Vector3d& velocity) const {
  const double square = std::max(velocity.squaredNorm(), config_.velocity_floor * config_.velocity_floor);
  return std::min(config_.damping_limit, energy_deficit / (square * config_.recovery_time));
}

void EnergyGate::changeShare(double work, bool absorbs, double energy_margin, double dt) {
  constexpr double kLargestFactor = 256;
  if (share_ < 1 && (energy_margin > 0 || absorbs)) {
    share_ = std::min(1.0, share_ + dt / (return_time_factor_ * config_.return_time));
    rising_ = true;
  }
  if (work <= 0) return;
  // The share falls with the margin, so the force fades over millimetres instead of dropping at
  // zero margin.
  const double largest = std::max(0.0, energy_margin) / std::max(work, config_.fade);
  if (share_ <= largest) return;
  share_ = largest;
  if (rising_) return_time_factor_ = std::min(kLargestFactor, 2 * return_time_factor_);
  rising_ = false;
}

Eigen::Vector3d EnergyGate::step(const Eigen::Vector3d& wanted, const Eigen::Vector3d& velocity, double energy_margin,
                                 double dt) {
  const double work = wanted.dot(velocity) * dt;  // J, on the hand, of the whole force
  changeShare(work, work < 0 && velocity.norm() > config_.velocity_floor, energy_margin, dt);
  const double added = damping(std::max(0.0, -energy_margin), velocity);
  acting_ = share_ < 1 || added > 0;
  // Without action the wanted force passes unchanged to the last bit.
  return acting_ ? Eigen::Vector3d(share_ * wanted - added * velocity) : wanted;
}

}  // namespace microinjection
