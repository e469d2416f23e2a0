#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "hardware/manipulator/homing_plan.h"

namespace microinjection {

/// Capabilities of a micromanipulator, to which its clients adapt: Micromanipulator by streaming set-points or not,
/// the injection controller by a speed at which the needle stays near its set-point. An interface that hid the
/// differences would have to be as slow as the slowest device, or would promise what a serial line of 9600 bit/s
/// cannot keep. They may change once a driver has measured its line.
///
///     follows   set-points                              moves                     devices
///     true      followed as they come                   a stream of set-points    simulated, Zaber, external
///     false     short moves, each to the newest one     the device's own move     all others
struct ManipulatorAbilities {
  std::string device;           ///< its commercial name, e.g. "Sutter MP-285"
  bool follows = false;         ///< accepts set-points while it moves; otherwise it makes one short move after another
  double command_interval = 0;  ///< s, smallest interval between set-points; 0: every step
  double reading_interval = 0;  ///< s, between measured positions; 0: every step
  double resolution = 0;        ///< m, of a commanded position
  double speed = 0;             ///< m/s, largest of an axis
  double latency = 0;           ///< s, from a command to the start of the motion, including the line
  double stop_time = 0;         ///< s, from a stop command to standstill, including the line
};

/// Interface of the three axes of a micromanipulator: a simulation, or the driver of a real device. Positions are
/// those of the URDF's joints (m). The driver converts them to the device's own directions, origin and counts.
///
///     Micromanipulator --> follow, moveTo, stop --> stored --> step(time) --> the line --> the device
///                      <-- reading, state, moving <----------- step(time) <-- the line <--
///
/// No function blocks, because the node steps at 1 kHz and a reply takes some milliseconds; a thread for each line
/// would only move the waiting to where it cannot be tested in virtual time. A command is stored, the newest replaces
/// earlier ones, and `step` sends it. A stop goes before all others. After a connection loss the driver reconnects by
/// itself; the device then rests until the next command, since nobody knows what has become of the needle meanwhile.
///
/// test/hardware/devices/contract_test.cpp states what each device has to keep.
class ManipulatorDevice {
 public:
  /// kDisconnected ends by itself; kFault by clearFault() only, since a person has to look at its cause.
  enum class State { kDisconnected, kReady, kFault };

  struct Reading {
    Eigen::Vector3d joints = Eigen::Vector3d::Zero();    ///< m; extrapolated along the motion between measurements
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  };

  virtual ~ManipulatorDevice() = default;

  virtual ManipulatorAbilities abilities() const = 0;

  /// Limits the speed of each joint (m/s, > 0), also while the device catches up with its goal.
  virtual void limitSpeed(const Eigen::Vector3d& axes) = 0;
  /// Position (m) of each joint at its axis' reference position, if the axes home by themselves;
  /// otherwise empty.
  virtual std::optional<Eigen::Vector3d> homingEnds() const { return std::nullopt; }
  /// Sets how the axes may home. Must be called before the first step if homingEnds() is not empty.
  virtual void planHoming(const HomingPlan& plan) { (void)plan; }
  /// Follows a stream of set-points: joint positions (m) and their velocity (m/s).
  virtual void follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) = 0;
  /// Moves to a position (m) in a straight line at `speed` (m/s, along the line), with the device's
  /// own profile if it has one.
  virtual void moveTo(const Eigen::Vector3d& joints, double speed) = 0;
  /// Stops at once, before any other pending command.
  virtual void stop() = 0;
  /// Leaves kFault if its cause is gone; the device then rests.
  virtual void clearFault() = 0;

  /// Communicates and moves. `time` (s) never decreases.
  virtual void step(double time) = 0;

  virtual State state() const = 0;
  virtual std::string reason() const = 0;              ///< why the state is not kReady; empty if it is
  virtual std::string note() const { return ""; }      ///< a warning while the device works
  virtual std::optional<Reading> reading() const = 0;  ///< empty while the position is unknown
  virtual bool moving() const = 0;                     ///< has not reached its goal
};

}  // namespace microinjection
