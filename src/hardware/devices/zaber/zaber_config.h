#pragma once

#include <array>

#include "base/config_reader.h"
#include "hardware/devices/joint_axes.h"
#include "hardware/devices/zaber/zaber_protocol.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {

/// Device data of a speed of 1 microstep/s (Zaber's ASCII protocol manual; Micro-Manager's Zaber
/// adapter).
constexpr double kZaberSpeedUnit = 1.6384;
constexpr int kZaberCommandBytes = 36;  ///< of a long command, "/1 1 57 move abs 524934 68801:98\n" with larger numbers
constexpr int kZaberReplyBytes = 28;    ///< of a long reply

/// Exchanges in a turn: one velocity and one position reading for each axis.
constexpr int kZaberTurn = 6;

struct ZaberConfig {
  SerialPortConfig port{"", 115200};
  std::array<ZaberAddress, 3> addresses{{{1, 1}, {1, 2}, {1, 3}}};  ///< of the axes of the joints
  JointAxes joints;
  Eigen::Vector3d microsteps_per_metre = Eigen::Vector3d::Constant(1 / 0.047625e-6);
  double speed = 2e-3;            ///< m/s, largest of an axis
  double acceleration = 0.2;      ///< m/s^2, of the axes' settings, up and down; compared with the device's
  int resolution = 64;            ///< microsteps per full step for which microsteps_per_metre is valid; 0: not compared
  double gain = 0;                ///< 1/s, velocity per distance from the set-point; 0: from the line's speed
  double move_horizon = 0.25;     ///< s, until a motion towards set-points ends unless renewed
  bool checksum = true;           ///< on every command, so that the device rejects damaged ones
  bool reply_checksum = false;    ///< replies without one are rejected
  bool numbers = true;            ///< on every command and its reply, so that late replies are rejected
  bool home = false;              ///< axes without a reference position home, which MOVES them
  double answer_time = 2e-3;      ///< s, smallest reply time of the device; the actual one is measured
  double reply_timeout = 0.05;    ///< s, until a reply is missing, in addition to the transmission
  double reading_margin = 10e-6;  ///< m, tolerance of a reading while moving, in addition to the motion

  double byteTime() const { return 10.0 / port.baud; }  ///< s
  double exchangeTime(double reply) const;              ///< s, of a long command and its reply, with the reply time
  /// Smallest move_horizon (s): a shorter one makes the motion jerky.
  double leastHorizon(double turn, double braking) const { return 2 * turn + speed / braking; }

  static ZaberConfig read(ConfigReader& reader);
};

}  // namespace microinjection
