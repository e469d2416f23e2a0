#pragma once

#include <Eigen/Geometry>
#include <limits>

#include "rig/manipulator/convex_minimum.h"

namespace microinjection {

/// A convex body that stands still.
struct Solid {
  enum class Shape { kBox, kCylinder, kSphere };
  Shape shape = Shape::kSphere;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in `world`; a cylinder's axis is its z
  Eigen::Vector3d half = Eigen::Vector3d::Zero();          ///< m: half edges | radius, -, half length | radius, -, -

  struct Nearest {
    double distance = 0;                             ///< m, of the point from the solid; 0 inside
    Eigen::Vector3d away = Eigen::Vector3d::Zero();  ///< its gradient, `world`: unit vector; 0 inside
  };
  Nearest nearest(const Eigen::Vector3d& point) const;  ///< m, `world`
};

/// All points within `radius` of a segment (m, `world`); a sphere when its ends are the same.
struct Capsule {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Distance (m, to 1e-10) of a capsule moved by `offset` (m) from a solid, below 0 where they overlap (not the depth).
/// A distance above `enough` need only be some lower bound of it that is above `enough`.
double distance(const Capsule& capsule, const Eigen::Vector3d& offset, const Solid& solid,
                double enough = std::numeric_limits<double>::infinity());

/// The smallest such distance on the straight way from one offset to the other.
double distanceAlongPath(const Capsule& capsule, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                         const Solid& solid, double enough = std::numeric_limits<double>::infinity());

}  // namespace microinjection
