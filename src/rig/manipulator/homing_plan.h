#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace microinjection {

class CollisionGuard;
struct ManipulatorGeometry;

/// How a device's axes look for their reference positions without meeting an obstacle.
struct HomingPlan {
  std::array<int, 3> order{0, 1, 2};  ///< of the joints, one after the other, all of them
  std::string refusal;                ///< why the axes must not home by themselves; empty: they may, in that order
};

/// Looks for an order in which each axis gets to its reference position `ends` (m, of the joints) without coming nearer
/// to an obstacle than the guard's margin, wherever within its travel each axis is at the begin: without a reference
/// nobody knows. Places are 1 mm apart, closer near 0 where the needle works; the way from each is tried exactly.
HomingPlan planHoming(const ManipulatorGeometry& geometry, const CollisionGuard& guard, const Eigen::Vector3d& ends);

}  // namespace microinjection
