#include "operation/teleoperation/virtual_coupling.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

VirtualCouplingConfig VirtualCouplingConfig::read(ConfigReader reader) {
  VirtualCouplingConfig config;
  reader.boolean("enabled", config.enabled);
  reader.number("stiffness", config.stiffness, Range::positive());
  reader.number("damping", config.damping, Range::positive());
  reader.number("lateness", config.lateness, Range::nonNegative());
  return config;
}

double VirtualCoupling::contactDamping(double stiffness) const {
  return std::min(config_.damping, config_.lateness * stiffness);
}

const Eigen::Vector3d& VirtualCoupling::step(const Eigen::Vector3d& force, double dt) {
  if (!config_.enabled) return proxy_offset_;
  // Exact for a force that is constant within the step.
  const double left = std::exp(-dt * config_.stiffness / config_.damping);
  proxy_offset_ = left * proxy_offset_ + (1 - left) / config_.stiffness * force;
  return proxy_offset_;
}

}  // namespace microinjection
