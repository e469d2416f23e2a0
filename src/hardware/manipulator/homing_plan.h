#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace microinjection {

class CollisionGuard;
struct ManipulatorGeometry;

/// How a device's axes can search for their reference positions without a collision.
struct HomingPlan {
  std::array<int, 3> order{0, 1, 2};  ///< of the joints, all of them, one after the other
  std::string refusal;                ///< why the axes must not home; empty: they may, in that order
};

/// Searches an order in which each axis reaches its reference position `ends` (m, of the joints)
/// and keeps the guard's margin. The start may be anywhere within the travel, because an axis
/// without a reference has no known position. The start positions are 1 mm apart, and closer near 0
/// where the needle works. The path from each of them is checked exactly.
HomingPlan planHoming(const ManipulatorGeometry& geometry, const CollisionGuard& guard, const Eigen::Vector3d& ends);

}  // namespace microinjection
