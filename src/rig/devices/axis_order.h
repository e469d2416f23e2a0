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

}  // namespace microinjection
