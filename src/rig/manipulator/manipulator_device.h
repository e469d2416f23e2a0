#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "rig/manipulator/homing_plan.h"

namespace microinjection {

/// What a micromanipulator can do, told honestly: who commands it adapts to this.
struct ManipulatorAbilities {
  std::string device;    ///< the field's name of it, e.g. "Sutter MP-285"
  bool follows = false;  ///< takes new set-points while it moves; otherwise it goes from one short move to the next
  double command_interval = 0;  ///< s, between set-points that it can take; 0: each one
  double reading_interval = 0;  ///< s, between true readings of its position; 0: at every step
  double resolution = 0;        ///< m, of a commanded position
  double speed = 0;             ///< m/s, largest of an axis
  double latency = 0;           ///< s, from a command to the motion's begin, wire included
  double stop_time = 0;         ///< s, from a stop to standstill, wire included
};

/// The three axes behind the micromanipulator's topics: a model, or a real device behind its protocol. Positions are
/// those of the URDF's joints (m); which way a device counts, and from where, is its own driver's business.
///
/// Nothing here waits: commands are noted (the newest wins) and sent by `step`. A device whose line breaks stops what
/// it can and connects again by itself; it then rests until the next command.
class ManipulatorDevice {
 public:
  enum class State { kDisconnected, kReady, kFault };

  struct Reading {
    Eigen::Vector3d joints =
        Eigen::Vector3d::Zero();  ///< m; between true readings carried on along the motion under way
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  };

  virtual ~ManipulatorDevice() = default;

  virtual ManipulatorAbilities abilities() const = 0;

  /// Keeps every axis within its speed (m/s, > 0, of each joint), however far it is behind where it was sent.
  virtual void limitSpeed(const Eigen::Vector3d& axes) = 0;
  /// Where each joint (m) gets to when its axis looks for its reference position by itself; empty: no axis does.
  virtual std::optional<Eigen::Vector3d> homingEnds() const { return std::nullopt; }
  /// How the axes may look for it, or why not. To be called before the first step where homingEnds() is not empty.
  virtual void planHoming(const HomingPlan& plan) { (void)plan; }
  /// Follows a stream of set-points: joint positions (m) and their velocity (m/s).
  virtual void follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) = 0;
  /// Goes there (m) in a straight line at `speed` (m/s, along the line), by the device's own profile where it has one.
  virtual void moveTo(const Eigen::Vector3d& joints, double speed) = 0;
  /// Stops, at once and before anything else that waits to be sent.
  virtual void stop() = 0;
  /// Leaves kFault when its cause is gone; the device rests then.
  virtual void clearFault() = 0;

  /// Talks and moves; `time` (s) never goes back.
  virtual void step(double time) = 0;

  virtual State state() const = 0;
  virtual std::string why() const = 0;                 ///< why it is not kReady; empty when it is
  virtual std::string note() const { return ""; }      ///< what an operator should know although it works
  virtual std::optional<Reading> reading() const = 0;  ///< empty while the position is not known
  virtual bool moving() const = 0;                     ///< has not arrived where it was sent
};

}  // namespace microinjection
