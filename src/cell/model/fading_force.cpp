#include "cell/model/fading_force.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

void FadingForce::start(const Eigen::Vector3d& force, const Eigen::Vector3d& tip, double energy, double time) {
  const double size = force.norm();
  force_ = force;
  direction_ = size > 0 ? Eigen::Vector3d(force / size) : Eigen::Vector3d::Zero();
  fade_distance_ = size > 0 ? 2 * std::max(energy, 0.0) / size : 0;
  tip_ = tip;
  time_ = time;
}

Eigen::Vector3d FadingForce::at(const Eigen::Vector3d& tip, double time) const {
  constexpr double kMostAges = 21;  // e^-21 is below 1e-9
  const double age = std::max(time - time_, 0.0) / relaxation_time_;
  const double distance = (tip - tip_).dot(direction_);
  if (age > kMostAges || (distance > 0 && distance >= fade_distance_)) return Eigen::Vector3d::Zero();
  return std::exp(-age) * (distance > 0 ? 1 - distance / fade_distance_ : 1) * force_;
}

}  // namespace microinjection
