#include "operation/teleoperation/contact_displacement.h"

#include <algorithm>
#include <limits>

namespace microinjection {

void ContactDisplacement::touch(const Eigen::Vector3d& force) {
  touched_ = force.norm();
  if (!isTouching()) way_.setZero();
  pressed_ = std::max(0.0, -force.dot(way_));
}

double ContactDisplacement::stiffness() const {
  if (!isTouching()) return 0;
  return pressed_ > 0 ? touched_ * touched_ / pressed_ : std::numeric_limits<double>::infinity();
}

}  // namespace microinjection
