#pragma once

#include <array>

#include "base/config_reader.h"
#include "rigs/joint_axes.h"
#include "rigs/zaber/zaber_protocol.h"
#include "serial/serial_port.h"

namespace microinjection {

/// Data of the device's speeds for 1 microstep/s (Zaber's ASCII protocol manual; Micro-Manager's Zaber adapter).
constexpr double kZaberSpeedUnit = 1.6384;

struct ZaberConfig {
  SerialPortConfig port;
  std::array<ZaberAddress, 3> addresses{{{1, 1}, {1, 2}, {1, 3}}};  ///< of the joints' axes
  JointAxes joints;
  Eigen::Vector3d microsteps_per_metre = Eigen::Vector3d::Constant(1 / 0.047625e-6);
  double speed = 2e-3;           ///< m/s, largest of an axis
  double acceleration = 0.2;     ///< m/s^2, that the axes are set to: how long a stop takes
  double gain = 0;               ///< 1/s, velocity for a distance from the set-point; 0: from the line's speed
  bool checksum = false;         ///< on every message, both ways
  bool home = false;             ///< axes without a reference position home by themselves, which MOVES them
  double answer_time = 2e-3;     ///< s, that the device takes to answer
  double reply_timeout = 0.05;   ///< s, after which an answer is missed, besides the time on the wire
  double reading_margin = 10e-6; ///< m, by which a reading under way may differ from what is expected, besides motion

  static ZaberConfig read(ConfigReader& reader);
};

}  // namespace microinjection
