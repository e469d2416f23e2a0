#pragma once

#include <Eigen/Geometry>
#include <string>

#include "base/config_reader.h"
#include "manipulator/manipulator_geometry.h"

namespace microinjection {

struct MicromanipulatorConfig {
  double servo_time_constant = 2e-3;      ///< s, first-order lag of the tip behind its set-point
  double acceleration = 0.02;             ///< m/s^2, of move_cp and servo_cv
  double velocity_command_timeout = 0.1;  ///< s, a servo_cv older than this means stop

  static MicromanipulatorConfig read(ConfigReader& reader);
};

/// A simulated three-axis micromanipulator that carries the injection pipette; its orientation is fixed.
///
/// The set-point follows the last accepted command within the URDF's travel and velocity; the tip follows the
/// set-point with a first-order lag. A refused command leaves everything as it was.
class Micromanipulator {
 public:
  Micromanipulator(const ManipulatorGeometry& geometry, const MicromanipulatorConfig& config);

  /// Each command returns an empty text when accepted, otherwise the reason for its refusal. `time` in s.
  std::string servoPosition(const Eigen::Isometry3d& tip_pose);             ///< CRTK servo_cp; m, `world`
  std::string servoVelocity(const Eigen::Vector3d& velocity, double time);  ///< CRTK servo_cv; m/s, `world`
  std::string movePosition(const Eigen::Isometry3d& tip_pose);              ///< CRTK move_cp; m, `world`
  void stop();                                                              ///< holds where the set-point is

  /// Advances by dt (s, > 0) to `time` (s).
  void step(double time, double dt);

  Eigen::Isometry3d tipPose() const;                                                ///< `needle_tip` in `world`
  Eigen::Vector3d tipVelocity() const;                                              ///< m/s, `world`
  const Eigen::Vector3d& joints() const { return joints_; }                         ///< m
  bool moving() const { return mode_ == Mode::kMove || mode_ == Mode::kVelocity; }  ///< of such a command

 private:
  enum class Mode { kHold, kServo, kVelocity, kMove };
  std::string checkPose(const Eigen::Isometry3d& tip_pose, Eigen::Vector3d& joints) const;
  void stepMove(double dt);
  void stepVelocity(double time, double dt);
  void advanceSetpoint(const Eigen::Vector3d& joint_step, double dt);

  ManipulatorGeometry geometry_;
  MicromanipulatorConfig config_;
  Mode mode_ = Mode::kHold;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();              ///< m, joints
  Eigen::Vector3d setpoint_ = Eigen::Vector3d::Zero();          ///< m, joints
  Eigen::Vector3d joints_ = Eigen::Vector3d::Zero();            ///< m
  Eigen::Vector3d joint_velocity_ = Eigen::Vector3d::Zero();    ///< m/s
  Eigen::Vector3d velocity_command_ = Eigen::Vector3d::Zero();  ///< m/s, joints
  Eigen::Vector3d profile_velocity_ = Eigen::Vector3d::Zero();  ///< m/s, joints, of the set-point in a move
  double velocity_command_time_ = 0;                            ///< s
};

}  // namespace microinjection
