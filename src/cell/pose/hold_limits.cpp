#include "cell/pose/hold_limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <limits>

namespace microinjection {

HoldLimits::HoldLimits(double suction, double seal_radius, double radius, double friction)
    : suction_(suction),
      seal_(seal_radius),
      radius_(radius),
      friction_(friction),
      cosine_(std::sqrt(std::max(1 - std::pow(seal_radius / radius, 2), 0.0))) {}

double HoldLimits::opening() const { return sideways() / 2; }

double HoldLimits::sideways() const { return suction_ * seal_ / (radius_ * cosine_); }

double HoldLimits::turning() const {
  return friction_ * suction_ / cosine_ * radius_ * M_2_PI * boost::math::ellint_2(seal_ / radius_);
}

double HoldLimits::spinning() const { return friction_ * suction_ / cosine_ * seal_; }

double HoldLimits::atPole() const { return largest({0, 0, -radius_}, Eigen::Vector3d::UnitX()); }

double HoldLimits::largest(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d d = direction.normalized(), z = Eigen::Vector3d::UnitZ(), moment = point.cross(d);
  const double pull = -d.z();
  double largest = std::numeric_limits<double>::infinity();
  // A force that pulls relieves the lip: each limit is capacity * (suction - pull * force) = demand * force.
  const auto limit = [&](double capacity, double demand) {
    const double per_force = demand + capacity * pull;
    if (per_force > 0) largest = std::min(largest, capacity * suction_ / per_force);
  };
  limit(1, 0);
  if (suction_ <= 0) return 0;
  limit(turning() / suction_, moment.head<2>().norm());
  limit(spinning() / suction_, std::abs(moment.z()));
  // About the point of the circle over which the force tips the sphere.
  limit(seal_, (moment - radius_ * cosine_ * z.cross(d)).head<2>().norm());
  return largest;
}

}  // namespace microinjection
