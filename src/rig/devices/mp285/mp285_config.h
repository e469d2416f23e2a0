#pragma once

#include "rig/devices/move_by_move.h"

namespace microinjection {

struct Mp285Config : MoveByMoveConfig {
  /// m per microstep of the device's axes X, Y, Z; 0: from its status, if that is a known one
  Eigen::Vector3d microsteps = Eigen::Vector3d::Zero();
  double command_pause = 2e-3;     ///< s, between a reply and the next command
  double half_command_time = 0.3;  ///< s of silence after which the device discards an incomplete command

  /// `rest_reading_interval` may be 0: no readings at rest.
  static Mp285Config read(ConfigReader& reader);
};

}  // namespace microinjection
