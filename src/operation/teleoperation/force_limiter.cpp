#include "operation/teleoperation/force_limiter.h"

#include <algorithm>

#include "base/vectors.h"

namespace microinjection {

ForceLimits ForceLimits::read(ConfigReader& reader) {
  ForceLimits limits;
  reader.number("force_limit", limits.force, Range::positive());
  reader.number("force_rate_limit", limits.rate, Range::positive());
  return limits;
}

const Eigen::Vector3d& ForceLimiter::step(const Eigen::Vector3d& wanted, const Eigen::Vector3d& velocity, double dt) {
  constexpr double kStill = 1e-3;  // m/s, below which a direction of motion is noise
  const Eigen::Vector3d target = clampedNorm(wanted, limits_.force);
  const double lag = (target - force_).norm();
  // A target within reach is taken exactly: a force at rest equals the wanted one to the last bit.
  force_ =
      lag <= limits_.rate * dt ? target : Eigen::Vector3d(force_ + clampedNorm(target - force_, limits_.rate * dt));
  if (velocity.norm() < kStill) return force_;
  const Eigen::Vector3d along = velocity.normalized();
  const double excess = force_.dot(along) - std::max(0.0, target.dot(along));
  if (excess > 0) force_ -= excess * along;
  return force_;
}

}  // namespace microinjection
