#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

/// Maps a device's axes to the URDF's joints: joint i is at origin[i] (m) when its axis reads 0,
/// and moves in the same direction (1) or the opposite one (-1).
struct JointAxes {
  Eigen::Vector3d directions = Eigen::Vector3d::Ones();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m

  static JointAxes read(ConfigReader& reader);

  Eigen::Vector3d toJoints(const Eigen::Vector3d& device) const { return origin + directions.cwiseProduct(device); }
  Eigen::Vector3d toDevice(const Eigen::Vector3d& joints) const { return directions.cwiseProduct(joints - origin); }
};

}  // namespace microinjection
