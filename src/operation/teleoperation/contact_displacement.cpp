#include "operation/teleoperation/contact_displacement.h"

#include <algorithm>
#include <limits>

namespace microinjection {

void ContactDisplacement::setForce(const Eigen::Vector3d& force) {
  force_ = force.norm();
  if (!isTouching()) displacement_.setZero();
  contact_work_ = std::max(0.0, -force.dot(displacement_));
}

double ContactDisplacement::stiffness() const {
  if (!isTouching()) return 0;
  return contact_work_ > 0 ? force_ * force_ / contact_work_ : std::numeric_limits<double>::infinity();
}

}  // namespace microinjection
