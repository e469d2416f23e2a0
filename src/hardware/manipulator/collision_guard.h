#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "hardware/manipulator/manipulator_geometry.h"
#include "hardware/manipulator/solid.h"

namespace microinjection {

/// Keeps a margin between the links that the manipulator moves and the fixed links, by the
/// <collision> shapes of the rig's URDF.
///
/// Fixed shapes may be boxes, cylinders and spheres. Moving shapes may be spheres and cylinders; a
/// cylinder is enlarged by a hemisphere at each end. A link without a <collision>, such as the
/// cell, is no obstacle. Joint positions are in m.
class CollisionGuard {
 public:
  CollisionGuard() = default;  ///< for a rig without obstacles

  /// @param geometry  of the same URDF, with the pipette's tilt
  /// @param margin    m, between moving and fixed shapes
  /// @throws ConfigError for other shapes.
  CollisionGuard(const std::string& xml, const ManipulatorGeometry& geometry, double margin);

  /// Returns an empty text when the margin is kept, otherwise the links and their distance.
  std::string blocks(const Eigen::Vector3d& joints) const;

  /// The same check for a whole straight path. It is exact: the solids are convex, so their
  /// distance is a convex function along the path. A path that starts within the margin may leave
  /// it, but not come closer.
  std::string blocksPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// Smallest distance (m) between a moving and a fixed shape; infinite without such a pair, 0 for
  /// overlap.
  double clearance(const Eigen::Vector3d& joints) const;

 private:
  struct Obstacle {
    std::string link;
    Solid solid;
  };
  struct Mover {
    std::string link;
    Eigen::Matrix3d directions;  ///< displacement in `world` per displacement of each joint
    Capsule capsule;             ///< with all joints at 0
  };
  std::string reason(const Mover& mover, const Obstacle& obstacle, double distance) const;

  std::vector<Obstacle> obstacles_;
  std::vector<Mover> movers_;
  double margin_ = 0;  ///< m
};

}  // namespace microinjection
