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
///
/// A second manipulator's links are obstacles where it is at the moment (placeOther). Of two pipettes the needle's is
/// the capsule, whoever of them moves: the holding pipette's flat mouth, with a hemisphere on it, would reach into the
/// cell.
class CollisionGuard {
 public:
  CollisionGuard() = default;  ///< for a rig without obstacles

  /// @param geometry  of the same URDF, with the pipette's tilt
  /// @param margin    m, between moving and fixed shapes
  /// Which shape has what this manipulator moves, against what a second one moves.
  enum class Role {
    kCapsule,  ///< of the needle
    kSolid     ///< of the holding pipette; a fixed shape that it overlaps with all joints at 0 is never checked, such
               ///< as the dish that it comes through
  };
  /// @param other  null, or that of a second manipulator in the URDF
  /// @throws ConfigError for other shapes.
  CollisionGuard(const std::string& xml, const ManipulatorGeometry& geometry, double margin,
                 const ManipulatorGeometry* other = nullptr, Role role = Role::kCapsule);

  /// Joint positions (m) of the second manipulator; at first all are 0.
  void placeOther(const Eigen::Vector3d& joints) { other_ = joints; }

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
  /// Displacement in `world` of a link per displacement of each joint.
  struct Motion {
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();    ///< of this manipulator
    Eigen::Matrix3d other = Eigen::Matrix3d::Zero();  ///< of the second one
  };
  /// Two shapes whose distance this manipulator changes.
  struct Pair {
    std::string mover, obstacle;  ///< links, as a reason names them
    Motion motion;                ///< of the capsule as seen from the solid
    Capsule capsule;              ///< with all joints at 0
    Solid solid;
  };
  struct Shape;
  void addPair(const Shape& capsule, const Shape& solid);
  Eigen::Vector3d offset(const Pair& pair, const Eigen::Vector3d& joints) const {
    return pair.motion.own * joints + pair.motion.other * other_;
  }
  std::string reason(const Pair& pair, double distance) const;

  std::vector<Pair> pairs_;
  double margin_ = 0;                                ///< m
  Eigen::Vector3d other_ = Eigen::Vector3d::Zero();  ///< m, joints of the second manipulator
};

}  // namespace microinjection
