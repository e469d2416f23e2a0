#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Metres in rviz per metre of the scene, for a cell of 56 um: 100 um becomes 1 m. rviz cannot show
/// micrometres, because its near clip and its smallest orbit distance are millimetres.
constexpr double kDisplayScale = 1e4;

/// From SI (m) to display units (m times `enlargement`).
inline Eigen::Vector3d toDisplay(const Eigen::Vector3d& point, double enlargement = kDisplayScale) {
  return enlargement * point;
}
/// From display units to SI (m).
inline Eigen::Vector3d fromDisplay(const Eigen::Vector3d& point, double enlargement = kDisplayScale) {
  return point / enlargement;
}

}  // namespace microinjection
