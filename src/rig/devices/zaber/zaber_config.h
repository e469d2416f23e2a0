#pragma once

#include <array>

#include "base/config_reader.h"
#include "rig/devices/joint_axes.h"
#include "rig/devices/zaber/zaber_protocol.h"
#include "rig/serial/serial_port.h"

namespace microinjection {

/// Data of the device's speeds for 1 microstep/s (Zaber's ASCII protocol manual; Micro-Manager's Zaber adapter).
constexpr double kZaberSpeedUnit = 1.6384;
constexpr int kZaberCommandBytes =
    36;                               ///< of a longer command: "/1 1 57 move abs 524934 68801:98\n" and larger numbers
constexpr int kZaberReplyBytes = 28;  ///< of a longer answer

/// Exchanges in a turn, in which each axis gets a velocity and tells its place.
constexpr int kZaberTurn = 6;

struct ZaberConfig {
  SerialPortConfig port{"", 115200};
  std::array<ZaberAddress, 3> addresses{{{1, 1}, {1, 2}, {1, 3}}};  ///< of the joints' axes
  JointAxes joints;
  Eigen::Vector3d microsteps_per_metre = Eigen::Vector3d::Constant(1 / 0.047625e-6);
  double speed = 2e-3;            ///< m/s, largest of an axis
  double acceleration = 0.2;      ///< m/s^2, that the axes are set to, up and down; the device is asked, too
  int resolution = 64;            ///< microsteps of a full step that microsteps_per_metre holds for; 0: not asked
  double gain = 0;                ///< 1/s, velocity for a distance from the set-point; 0: from the line's speed
  double move_horizon = 0.25;     ///< s, after which a motion that follows set-points ends when it is not renewed
  bool checksum = true;           ///< on every command: a damaged one is then not obeyed
  bool reply_checksum = false;    ///< answers without one are not believed
  bool numbers = true;            ///< on every command, and so on its answer: a belated one is not believed
  bool home = false;              ///< axes without a reference position home by themselves, which MOVES them
  double answer_time = 2e-3;      ///< s, that the device takes to answer, at the least; more is measured
  double reply_timeout = 0.05;    ///< s, after which an answer is missed, besides the time on the wire
  double reading_margin = 10e-6;  ///< m, by which a reading under way may differ from what is expected, besides motion

  double byteTime() const { return 10.0 / port.baud; }  ///< s
  double exchangeTime(double answer) const;             ///< s, a longer message and its answer, which takes `answer` s
  /// s, that a motion which follows set-points must outlast when it is not renewed, or it would be one in jerks.
  double leastHorizon(double turn, double braking) const { return 2 * turn + speed / braking; }

  static ZaberConfig read(ConfigReader& reader);
};

}  // namespace microinjection
