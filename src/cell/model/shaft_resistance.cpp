#include "cell/model/shaft_resistance.h"

#include <algorithm>

namespace microinjection {

void ShaftResistance::enter(const Eigen::Vector3d& tip) {
  entered_at_ = last_ = tip;
  spring_origin_ = 0;
}

Eigen::Vector3d ShaftResistance::step(const Eigen::Vector3d& tip, const Eigen::Vector3d& axis, double length,
                                      double duration) {
  const Eigen::Vector3d move = tip - last_, displacement = tip - entered_at_;
  last_ = tip;
  const double inside = std::max(length, 0.0);
  const double longest = (config_.friction + config_.adhesion * inside) / config_.stiffness;
  spring_origin_ = std::clamp(spring_origin_ + move.dot(axis), -longest, longest);
  Eigen::Vector3d force = -config_.stiffness * spring_origin_ * axis;
  force -= config_.lateral_stiffness * (displacement - displacement.dot(axis) * axis);
  if (duration > 0) force -= config_.damping * inside / duration * move;
  return force;
}

}  // namespace microinjection
