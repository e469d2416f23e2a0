#pragma once

#include "base/config_reader.h"
#include "rig/devices/axis_order.h"
#include "rig/devices/joint_axes.h"
#include "rig/serial/serial_port.h"

namespace microinjection {

struct Mp285Config {
  SerialPortConfig port{"", 9600};
  AxisOrder axes;
  JointAxes joints;
  /// m, a microstep of the device's axes X, Y, Z; 0: by its status, if that is one of the known
  Eigen::Vector3d microsteps = Eigen::Vector3d::Zero();
  double speed = 1e-3;               ///< m/s, largest along a move
  double segment_time = 0.05;        ///< s, that a short move towards a set-point should take
  double answer_time = 5e-3;         ///< s, that the device takes to answer
  double command_pause = 2e-3;       ///< s, between an answer and the next command
  double reply_timeout = 0.3;        ///< s, after which an answer is missed, besides the time on the wire
  double half_command_time = 0.3;    ///< s of silence after which the device has forgotten half a command
  double rest_reading_interval = 1;  ///< s, between readings at rest; 0: none

  static Mp285Config read(ConfigReader& reader);
};

}  // namespace microinjection
