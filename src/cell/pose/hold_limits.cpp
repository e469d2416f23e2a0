#include "cell/pose/hold_limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

/// Of the angle between the axis and the normals of a circle on a sphere.
double cosineOf(double circle, double sphere) { return std::sqrt(std::max(1 - std::pow(circle / sphere, 2), 0.0)); }

}  // namespace

HoldLimits::HoldLimits(double suction, double seal_radius, double radius, double friction)
    : HoldLimits(suction, seal_radius, radius, friction, seal_radius) {}

HoldLimits::HoldLimits(double suction, double seal_radius, double radius, double friction, double released_radius)
    : suction_(suction), seal_(seal_radius), radius_(radius), friction_(friction), released_(released_radius) {}

double HoldLimits::pull() const { return seal_ > 0 ? suction_ * std::pow(released_ / seal_, 2) : 0; }

double HoldLimits::opening() const { return sideways() / 2; }

double HoldLimits::sideways() const { return pull() * released_ / (radius_ * cosineOf(released_, radius_)); }

double HoldLimits::turning() const {
  const double push = suction_ / cosineOf(seal_, radius_);
  return friction_ * push * radius_ * M_2_PI * boost::math::ellint_2(seal_ / radius_);
}

double HoldLimits::spinning() const { return friction_ * suction_ / cosineOf(seal_, radius_) * seal_; }

double HoldLimits::atPole() const { return largest({0, 0, -radius_}, Eigen::Vector3d::UnitX()); }

double HoldLimits::largest(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const {
  const Eigen::Vector3d d = direction.normalized(), z = Eigen::Vector3d::UnitZ(), moment = point.cross(d);
  const double along = -d.z();
  double largest = std::numeric_limits<double>::infinity();
  // A force that pulls relieves the lip: each limit is capacity * (suction - along * force) = demand * force.
  const auto limit = [&](double suction, double capacity, double demand) {
    const double per_force = demand + capacity * along;
    if (per_force > 0) largest = std::min(largest, capacity * suction / per_force);
  };
  limit(pull(), 1, 0);
  if (suction_ <= 0) return 0;
  limit(suction_, turning() / suction_, moment.head<2>().norm());
  limit(suction_, spinning() / suction_, std::abs(moment.z()));
  // About the point of the circle over which the force tips the sphere.
  const double height = radius_ * cosineOf(released_, radius_);
  limit(pull(), released_, (moment - height * z.cross(d)).head<2>().norm());
  return largest;
}

}  // namespace microinjection
