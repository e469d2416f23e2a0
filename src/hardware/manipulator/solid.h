#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace microinjection {

/// Value and slope of a convex function of one variable.
struct ValueSlope {
  double value = 0;
  double slope = 0;
};

/// Minimum of a convex function `f(x) -> ValueSlope` over [0, 1], to `accuracy`. If the minimum is
/// certainly above `enough`, some lower bound above `enough` is returned early. Two tangents bound
/// the minimum from below. Their intersection is the next trial point, or the middle of the
/// interval if that shrinks it too slowly (Kelley's cutting planes).
template <typename Function>
double convexMinimum(const Function& f, double accuracy, double enough) {
  double left = 0, right = 1;
  ValueSlope at_left = f(left);
  if (at_left.slope >= 0) return at_left.value;
  ValueSlope at_right = f(right);
  if (at_right.slope <= 0) return at_right.value;
  double best = std::min(at_left.value, at_right.value);
  bool halve = false;
  for (int i = 0; i < 200; ++i) {
    const double width = right - left;
    const double rise = at_right.slope - at_left.slope;  // > 0
    const double meet =
        std::clamp((at_left.value - at_right.value + at_right.slope * width) / rise, 0.0, width);  // from left
    const double bound = at_left.value + at_left.slope * meet;
    if (bound > enough || best - bound <= accuracy || width < 1e-15) return bound > enough ? bound : best;
    const double x = left + (halve ? width / 2 : meet);
    const ValueSlope here = f(x);
    best = std::min(best, here.value);
    if (here.slope == 0) return best;
    (here.slope < 0 ? left : right) = x;
    (here.slope < 0 ? at_left : at_right) = here;
    halve = right - left > width / 2;
  }
  return best;
}

/// A fixed convex body.
struct Solid {
  enum class Shape { kBox, kCylinder, kSphere };
  Shape shape = Shape::kSphere;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in `world`; a cylinder's axis is its z
  Eigen::Vector3d half = Eigen::Vector3d::Zero();          ///< m: half edges | radius, -, half length | radius, -, -

  struct Nearest {
    double distance = 0;                             ///< m, of the point from the solid; 0 inside
    Eigen::Vector3d away = Eigen::Vector3d::Zero();  ///< gradient of the distance in `world`, a unit vector; 0 inside
  };
  Nearest nearest(const Eigen::Vector3d& point) const;  ///< m, `world`
};

/// All points within `radius` of a segment (m, `world`); a sphere if its ends coincide.
struct Capsule {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Distance (m, to 1e-10) between a capsule displaced by `offset` (m) and a solid. Negative for
/// overlap, but not the penetration depth. If the distance exceeds `enough`, the result may be any
/// lower bound above `enough`.
double distance(const Capsule& capsule, const Eigen::Vector3d& offset, const Solid& solid,
                double enough = std::numeric_limits<double>::infinity());

/// The smallest such distance along a straight path between two offsets.
double distanceAlongPath(const Capsule& capsule, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                         const Solid& solid, double enough = std::numeric_limits<double>::infinity());

}  // namespace microinjection
