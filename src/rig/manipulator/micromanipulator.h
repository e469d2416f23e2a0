#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "rig/manipulator/collision_guard.h"
#include "rig/manipulator/manipulator_device.h"
#include "rig/manipulator/manipulator_geometry.h"
#include "rig/manipulator/straight_move.h"

namespace microinjection {

struct MicromanipulatorConfig {
  double pipette_tilt = 0;                ///< rad, of the URDF's revolute joint, for ManipulatorGeometry::fromUrdf
  double collision_margin = 2e-6;         ///< m, for CollisionGuard
  double command_timeout = 0.1;           ///< s, a servo_cp stream that pauses longer than this means stop
  double velocity_command_timeout = 0.1;  ///< s, a servo_cv older than this means stop
  double servo_speed_limit = std::numeric_limits<double>::infinity();  ///< m/s, of what servo_cp and servo_cv command

  static MicromanipulatorConfig read(ConfigReader& reader);
};

/// Interprets the commands of a micromanipulator's topics for a device, simulated or real, that carries the injection
/// pipette; the pipette's orientation is fixed.
///
/// A set-point follows the last accepted command within the URDF's travel, speed and acceleration and clear of
/// obstacles: at any time it could brake without leaving them, and the device's straight way to it is clear, too. A
/// command that changes no faster than that, and than servo_speed_limit, is followed without lag. The device follows
/// the set-point, or is sent where the set-point should go. A refused command leaves everything as it was. After a stop
/// or a fault the set-point is where the device says it is, and a stream of commands that went on meanwhile moves
/// nothing: it must pause for command_timeout first, or clearFault() be called when the device is ready.
class Micromanipulator {
 public:
  /// @param device  outlives this; is limited to the axes' speeds
  Micromanipulator(const ManipulatorGeometry& geometry, const CollisionGuard& guard,
                   const MicromanipulatorConfig& config, ManipulatorDevice& device);

  /// Each command returns an empty text when accepted, otherwise the reason for its refusal. `time` in s.
  std::string servoPosition(const Eigen::Isometry3d& tip_pose);             ///< CRTK servo_cp; m, `world`
  std::string servoVelocity(const Eigen::Vector3d& velocity, double time);  ///< CRTK servo_cv; m/s, `world`
  std::string movePosition(const Eigen::Isometry3d& tip_pose);              ///< CRTK move_cp; m, `world`
  void stop();                                                              ///< stops the device at once
  void clearFault();  ///< of the device, whose cause is gone; when there is none, lets a stream go on after a stop
  void letStreamGoOn() { held_off_ = false; }  ///< after a stop, without a pause

  /// Advances by dt (s, > 0) to `time` (s), and the device with it.
  void step(double time, double dt);

  /// What the device measures, of its axes; empty while it does not know.
  std::optional<Eigen::Isometry3d> tipPose() const;    ///< `needle_tip` in `world`
  std::optional<Eigen::Vector3d> tipVelocity() const;  ///< m/s, `world`
  std::optional<Eigen::Vector3d> joints() const;       ///< m

  /// Where the device is sent; empty when it is not.
  const std::optional<AxesMotion>& setpoint() const { return setpoint_; }
  /// CRTK setpoint_cp, `needle_tip` in `world`: where the next command takes over, which is where the device is at
  /// rest, and the goal of a device that goes by itself. Empty while it is not ready or follows a velocity.
  std::optional<Eigen::Isometry3d> setpointPose() const;
  /// CRTK is_busy: a move was accepted, and neither has the device come to rest nor has another command taken over.
  bool busy() const { return under_way_; }
  bool moving() const { return mode_ == Mode::kMove || mode_ == Mode::kVelocity; }  ///< of such a command
  ManipulatorDevice::State state() const { return device_->state(); }
  std::string why() const { return device_->why(); }   ///< why it is not ready; empty when it is
  const std::string& ended() const { return ended_; }  ///< why the last motion ended early; empty if it did not

 private:
  enum class Mode { kHold, kBrake, kServo, kVelocity, kMove };
  struct Commanded {
    Eigen::Vector3d joints;  ///< m
    std::string refusal;
  };
  void adapt();
  std::string unavailableReason() const;
  std::string streamRefusal();
  Commanded checkPose(const Eigen::Isometry3d& tip_pose) const;
  AxesMotion start() const;
  Eigen::Vector3d restAfter(const AxesMotion& motion) const;
  Eigen::Vector3d reachOf(const AxesMotion& motion) const;
  void begin(Mode mode, const AxesMotion& from);
  void rest();
  void halt();
  std::string blocksDevice(const Eigen::Vector3d& target) const;
  void haltIfCutOff();
  std::string advance(const Eigen::Vector3d& velocity, double dt);
  void stepMode(double time, double dt);
  double brakedSpeed(double dt) const;
  void stepServo(double dt);
  void stepMove(double dt);
  void stepVelocity(double time, double dt);
  void abortMotion(const std::string& why);
  void arrive();

  ManipulatorGeometry geometry_;
  CollisionGuard guard_;
  MicromanipulatorConfig config_;
  ManipulatorDevice* device_;
  bool accepts_setpoints_while_moving_;  ///< the device, set-points while it moves
  double lag_ = 0;  ///< s, that a device which follows may go on with a velocity that is no longer the set-point's
  Mode mode_ = Mode::kHold;
  std::optional<AxesMotion> setpoint_;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();                 ///< m, joints, of servo_cp and move_cp
  Eigen::Vector3d last_goal_ = Eigen::Vector3d::Zero();            ///< m, joints, of the servo_cp before
  bool goal_is_new_ = false;                                       ///< servo_cp: came since the last step
  double goal_age_ = 0;                                            ///< s, since the last servo_cp was taken up
  Eigen::Vector3d velocity_command_ = Eigen::Vector3d::Zero();     ///< m/s, joints
  double velocity_command_time_ = 0;                               ///< s
  bool under_way_ = false;                                         ///< see busy()
  bool held_off_ = false;                                          ///< streams are
  double stream_pause_ = std::numeric_limits<double>::infinity();  ///< s, since the last command of a stream
  std::string ended_;
  double last_dt_ = 0;  ///< s, of the last step; 0 before the first
};

}  // namespace microinjection
