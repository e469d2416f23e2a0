#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>

#include "base/config_reader.h"
#include "hardware/manipulator/collision_guard.h"
#include "hardware/manipulator/manipulator_device.h"
#include "hardware/manipulator/manipulator_geometry.h"
#include "hardware/manipulator/straight_move.h"

namespace microinjection {

struct MicromanipulatorConfig {
  double pipette_tilt = 0;                ///< rad, of the URDF's revolute joint, for ManipulatorGeometry::fromUrdf
  double collision_margin = 2e-6;         ///< m, for CollisionGuard
  double command_timeout = 0.1;           ///< s, a servo_cp stream that pauses longer is stale: the needle stops
  double velocity_command_timeout = 0.1;  ///< s, an older servo_cv is stale: the needle stops
  double servo_speed_limit = std::numeric_limits<double>::infinity();  ///< m/s, for servo_cp and servo_cv

  static MicromanipulatorConfig read(ConfigReader& reader);
};

/// Executes the commands of a micromanipulator's topics on a device, simulated or real, which carries the injection
/// pipette. The pipette's orientation is fixed. Travel, speed, acceleration and obstacles are checked here once for
/// all devices, so that neither a driver nor whoever commands can forget them.
///
///     servoPosition() --> kServo ------ stale -------------> the device is stopped --.
///     servoVelocity() --> kVelocity --- stale -------------> brakes -----------------+--> kHold
///     movePosition()  --> kMove ------- at its goal ---------------------------------+
///                         kVelocity, kMove -- no way on ---> kBrake -- at rest ------+
///     any mode -- stop(), device not ready, or displaced behind an obstacle ---------'    without a set-point
///
/// One rule keeps all limits: after each step the set-point could brake in a straight line within travel and clear of
/// obstacles; otherwise it brakes instead, on the line of the step before. To check the commanded pose alone would
/// not do, because the set-point has a speed, and the end of travel or a dish may lie within its braking distance.
/// Nor would a check of the set-point's own path: the device's straight path to it, from the measured position, must
/// be clear too, because something else may have displaced the needle. The set-point waits until it is. Nothing plans
/// a way round an obstacle: whoever commands decides on another way.
///
/// The set-point follows the last accepted command. One that changes no faster than the limits and servo_speed_limit
/// is followed without lag, a faster one overshoots by the braking distance, and a move ends exactly at its goal,
/// whatever the time steps are. A device that accepts set-points while it moves (ManipulatorAbilities::follows) gets
/// them also in a move; another one executes its own.
///
/// After a stop or a fault the set-point is the measured position. A stream of commands that continues through it
/// moves nothing until it has paused for command_timeout, or until clearFault() while the device is ready, or, after
/// a clearFault() while it was not, until it commands the needle to stay where it is: such a stream has seen the
/// stop, and nothing leaps.
///
/// A refused command changes nothing. Poses are in `world`, joints are the URDF's (m); all is for one thread.
class Micromanipulator {
 public:
  /// @param device  must outlive this object. Its speed is limited to that of the axes, and if its axes home by
  ///   themselves, the order in which they may is planned.
  Micromanipulator(const ManipulatorGeometry& geometry, const CollisionGuard& guard,
                   const MicromanipulatorConfig& config, ManipulatorDevice& device);

  /// Each command returns an empty text if accepted, otherwise the reason for the refusal. `time`
  /// in s.
  std::string servoPosition(const Eigen::Isometry3d& tip_pose);             ///< CRTK servo_cp; m, `world`, needle_tip
  std::string servoVelocity(const Eigen::Vector3d& velocity, double time);  ///< CRTK servo_cv; m/s, `world`
  std::string movePosition(const Eigen::Isometry3d& tip_pose);              ///< CRTK move_cp; m, `world`
  void stop();                                                              ///< stops the device at once
  void clearFault();  ///< clears the device's fault; without a fault, re-admits streams after a stop
  void allowStreams() { streams_blocked_ = false; }  ///< re-admits streams after a stop, without a pause

  /// Advances itself and the device by dt (s, > 0) to `time` (s), which never decreases.
  void step(double time, double dt);
  /// Joint positions (m) of a second manipulator, whose links are obstacles.
  void placeOther(const Eigen::Vector3d& joints) { guard_.placeOther(joints); }

  /// Measured by the device's axes; empty while the position is unknown.
  std::optional<Eigen::Isometry3d> tipPose() const;    ///< `needle_tip` in `world`
  std::optional<Eigen::Vector3d> tipVelocity() const;  ///< m/s, `world`
  std::optional<Eigen::Vector3d> joints() const;       ///< m

  /// The present set-point; empty without one.
  const std::optional<AxesMotion>& setpoint() const { return setpoint_; }
  /// CRTK setpoint_cp, `needle_tip` in `world`: where the next command starts. That is the measured
  /// position at rest, and the goal of a device that moves by itself. Empty while the device is not
  /// ready or follows a velocity.
  std::optional<Eigen::Isometry3d> setpointPose() const;
  /// CRTK is_busy: a move was accepted, the device has not come to rest, and no other command has
  /// replaced it.
  bool busy() const { return move_active_; }
  bool moving() const { return mode_ == Mode::kMove || mode_ == Mode::kVelocity; }  ///< executes servo_cv or move_cp
  /// Why a command of a stream would move nothing now; empty: it would move the needle.
  std::string streamHold() const;
  ManipulatorDevice::State state() const { return device_->state(); }
  std::string reason() const { return device_->reason(); }  ///< why the device is not ready; empty if it is
  const std::string& abortReason() const {
    return abort_reason_;
  }  ///< why the last motion was aborted; empty if it was not

 private:
  enum class Mode { kHold, kBrake, kServo, kVelocity, kMove };
  struct Commanded {
    Eigen::Vector3d joints;  ///< m
    std::string refusal;
  };
  void adapt();
  std::string unavailableReason() const;
  std::string streamRefusal();
  void admitIfHere(const Eigen::Isometry3d& tip_pose);
  Commanded checkPose(const Eigen::Isometry3d& tip_pose) const;
  AxesMotion start() const;
  Eigen::Vector3d restAfter(const AxesMotion& motion) const;
  Eigen::Vector3d reachOf(const AxesMotion& motion) const;
  void begin(Mode mode, const AxesMotion& from);
  void rest();
  void halt();
  std::string blocksDevice(const Eigen::Vector3d& target) const;
  void haltIfBlocked();
  std::string advance(const Eigen::Vector3d& velocity, double dt);
  void stepMode(double time, double dt);
  double brakedSpeed(double dt) const;
  void stepServo(double dt);
  void stepMove(double dt);
  void stepVelocity(double time, double dt);
  void abortMotion(const std::string& reason);
  void arrive();

  ManipulatorGeometry geometry_;
  CollisionGuard guard_;
  MicromanipulatorConfig config_;
  ManipulatorDevice* device_;
  bool accepts_setpoints_while_moving_;  ///< ManipulatorAbilities::follows of the device
  double lag_ = 0;                       ///< s, for which the device may continue with an outdated velocity
  Mode mode_ = Mode::kHold;
  std::optional<AxesMotion> setpoint_;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();                 ///< m, joints, of servo_cp and move_cp
  Eigen::Vector3d last_goal_ = Eigen::Vector3d::Zero();            ///< m, joints, of the previous servo_cp
  bool goal_is_new_ = false;                                       ///< servo_cp was received since the last step
  double goal_age_ = 0;                                            ///< s, since the last servo_cp was applied
  Eigen::Vector3d velocity_command_ = Eigen::Vector3d::Zero();     ///< m/s, joints
  double velocity_command_time_ = 0;                               ///< s
  bool move_active_ = false;                                       ///< see busy()
  bool streams_blocked_ = false;                                   ///< after a stop or fault, until a pause
  bool fault_cleared_ = false;                                     ///< by clearFault(), since streams were blocked
  double stream_pause_ = std::numeric_limits<double>::infinity();  ///< s, since the last command of a stream
  std::string abort_reason_;
  double last_dt_ = 0;  ///< s, of the last step; 0 before the first
};

}  // namespace microinjection
