#pragma once

#include <Eigen/Geometry>
#include <limits>

#include "hardware/manipulator/convex_minimum.h"

namespace microinjection {

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
