#pragma once

#include <array>

#include "base/config_reader.h"
#include "rigs/joint_axes.h"
#include "serial/serial_port.h"

namespace microinjection {

struct Mp285Config {
  SerialPortConfig port{"", 9600};
  std::array<int, 3> axes{0, 1, 2};  ///< the device's axis (0: X) of each joint
  JointAxes joints;
  double speed = 1e-3;               ///< m/s, largest along a move
  double segment_time = 0.05;        ///< s, that a short move towards a set-point should take
  double answer_time = 5e-3;         ///< s, that the device takes to answer
  double reply_timeout = 0.3;        ///< s, after which an answer is missed, besides the time on the wire
  double half_command_time = 0.3;    ///< s of silence after which the device has forgotten half a command
  double rest_reading_interval = 1;  ///< s, between readings at rest; 0: none

  static Mp285Config read(ConfigReader& reader);

  /// From the device's order of axes to the joints', and back; any unit.
  Eigen::Vector3d inJointOrder(const Eigen::Vector3d& device) const {
    return {device[axes[0]], device[axes[1]], device[axes[2]]};
  }
  Eigen::Vector3d inDeviceOrder(const Eigen::Vector3d& of_joints) const {
    Eigen::Vector3d device;
    for (int i = 0; i < 3; ++i) device[axes[i]] = of_joints[i];
    return device;
  }
};

}  // namespace microinjection
