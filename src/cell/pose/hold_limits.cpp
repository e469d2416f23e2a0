#include "cell/pose/hold_limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/ellint_2.hpp>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

/// Of the angle between the axis and the normals of a circle on a sphere.
double cosineOf(double circle, double sphere) { return std::sqrt(std::max(1 - std::pow(circle / sphere, 2), 0.0)); }

}  // namespace

HoldLimits::HoldLimits(double suction, double seal_radius, double radius, double friction)
    : HoldLimits(suction, seal_radius, radius, friction, {seal_radius, std::numeric_limits<double>::infinity()}) {}

HoldLimits::HoldLimits(double suction, double seal_radius, double radius, double friction, const SoftSeat& seat)
    : suction_(suction), seal_(seal_radius), radius_(radius), friction_(friction), seat_(seat) {}

double HoldLimits::pull() const { return seal_ > 0 ? suction_ * std::pow(seat_.released_radius / seal_, 2) : 0; }

double HoldLimits::opening() const { return sideways() / 2; }

double HoldLimits::sideways() const {
  return pull() * seat_.released_radius / (radius_ * cosineOf(seat_.released_radius, radius_));
}

double HoldLimits::turning() const {
  const double push = suction_ / cosineOf(seal_, radius_);
  return friction_ * push * radius_ * M_2_PI * boost::math::ellint_2(seal_ / radius_);
}

/// Of a load with the arm m (m) about the unloaded centre and the component a = `along` out of the pipette, the
/// smallest f > 0 with
///
///     f (m + a lambda M) = M,   M = (F - a f) turning / F      lambda: shift over moment, 1/N
///
/// infinite without one. The load's own component across the tube is left out of the shift.
double HoldLimits::turningLoad(double arm, double along) const {
  const double cosine = cosineOf(seal_, radius_), sine = seal_ / radius_;
  const double whole = turning(), k = whole / suction_;  // N m, of the suction alone; m
  const double inverse = M_2_PI * boost::math::ellint_1(sine);
  const double across =
      suction_ / cosine * std::min(friction_ * cosine * inverse, sine / 2);  // N, of the suction alone
  const double lambda = whole > 0 ? across / whole / seat_.lateral_stiffness : 0;
  // (along^2 lambda k) f^2 - (arm + along (lambda k F + k)) f + k F = 0
  const double square = along * along * lambda * k, line = arm + along * (lambda * whole + k);
  const double root = line * line - 4 * square * whole;
  if (line <= 0 || root < 0) return std::numeric_limits<double>::infinity();
  return 2 * whole / (line + std::sqrt(root));
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
  largest = std::min(largest, turningLoad(moment.head<2>().norm(), along));
  limit(suction_, spinning() / suction_, std::abs(moment.z()));
  // About the point of the circle over which the force tips the sphere.
  const double height = radius_ * cosineOf(seat_.released_radius, radius_);
  limit(pull(), seat_.released_radius, (moment - height * z.cross(d)).head<2>().norm());
  return largest;
}

}  // namespace microinjection
