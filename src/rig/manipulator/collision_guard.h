#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "rig/manipulator/manipulator_geometry.h"
#include "rig/manipulator/solid.h"

namespace microinjection {

/// Keeps what the manipulator carries away from what stands still, by the <collision> shapes of the rig's URDF.
///
/// Shapes that stand still may be boxes, cylinders and spheres; those that move, cylinders (taken with a half sphere on
/// each end, which only adds to them) and spheres. A link without a <collision>, as the cell, is no obstacle.
/// Positions are those of the three joints (m).
class CollisionGuard {
 public:
  CollisionGuard() = default;  ///< of a rig without obstacles

  /// @param geometry  of the same URDF, tilted as the pipette is
  /// @param margin    m, that must stay between a moving and a standing shape
  /// @throws ConfigError for shapes that are not as said.
  CollisionGuard(const std::string& xml, const ManipulatorGeometry& geometry, double margin);

  /// Empty when the margin is kept there, otherwise which links come how near.
  std::string blocks(const Eigen::Vector3d& joints) const;

  /// The same for the whole straight way, exactly: solids are convex, so that their distance is a convex function of
  /// the way. Who starts within the margin may leave, but not come nearer.
  std::string blocksPath(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

  /// Smallest distance (m) between a moving and a standing shape; infinite without such a pair, 0 where they overlap.
  double clearance(const Eigen::Vector3d& joints) const;

 private:
  struct Obstacle {
    std::string link;
    Solid solid;
  };
  struct Mover {
    std::string link;
    Eigen::Matrix3d directions;  ///< m of its motion in `world` per m of each joint
    Capsule capsule;             ///< with all joints at 0
  };
  std::string reason(const Mover& mover, const Obstacle& obstacle, double distance) const;

  std::vector<Obstacle> obstacles_;
  std::vector<Mover> movers_;
  double margin_ = 0;  ///< m
};

}  // namespace microinjection
