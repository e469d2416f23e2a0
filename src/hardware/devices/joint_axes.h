#pragma once

#include <Eigen/Core>
#include <array>

#include "base/config_reader.h"

namespace microinjection {

/// Maps the axes of a three-axis device to the joints. The file's key `axes` counts them from 1.
struct AxisOrder {
  std::array<int, 3> of_joint{0, 1, 2};  ///< 0: the device's X

  static AxisOrder read(ConfigReader& reader);

  /// Converts from the device's order of axes to the joints', and back; any unit.
  Eigen::Vector3d inJointOrder(const Eigen::Vector3d& device) const {
    return {device[of_joint[0]], device[of_joint[1]], device[of_joint[2]]};
  }
  Eigen::Vector3d inDeviceOrder(const Eigen::Vector3d& of_joints) const {
    Eigen::Vector3d device;
    for (int i = 0; i < 3; ++i) device[of_joint[i]] = of_joints[i];
    return device;
  }
};

/// Maps a device's axes to the URDF's joints: joint i is at origin[i] (m) when its axis reads 0,
/// and moves in the same direction (1) or the opposite one (-1). A joint is no place of the tip: joint z at 0 has the
/// tip at start_height above the cell's centre (doc/guide/your_rig.md, Find the origin).
struct JointAxes {
  Eigen::Vector3d directions = Eigen::Vector3d::Ones();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m

  static JointAxes read(ConfigReader& reader);

  Eigen::Vector3d toJoints(const Eigen::Vector3d& device) const { return origin + directions.cwiseProduct(device); }
  Eigen::Vector3d toDevice(const Eigen::Vector3d& joints) const { return directions.cwiseProduct(joints - origin); }
};

}  // namespace microinjection
