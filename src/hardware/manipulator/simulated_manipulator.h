#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <random>
#include <string>

#include "base/config_reader.h"
#include "hardware/manipulator/hysteresis.h"
#include "hardware/manipulator/manipulator_device.h"
#include "hardware/manipulator/manipulator_geometry.h"
#include "hardware/manipulator/straight_move.h"

namespace microinjection {

/// The defaults describe an ideal device with a servo lag. config/rigs/imperfect.yaml has the
/// figures of a real one.
struct SimulatedManipulatorConfig {
  double servo_time_constant = 2e-3;                     ///< s, first-order lag of a motor behind its set-point
  double resolution = 1e-9;                              ///< m, of a set-point
  double backlash = 0;                                   ///< m, lost at each reversal
  HysteresisConfig hysteresis;                           ///< between motor and tip, after the backlash
  Eigen::Vector3d drift_rate = Eigen::Vector3d::Zero();  ///< m/s, of the tip away from its axes, each axis
  double drift_walk = 0;                                 ///< of an additional random walk, each axis
  int seed = 1;                                          ///< of the random walk

  static SimulatedManipulatorConfig read(ConfigReader& reader);
};

/// A simulated micromanipulator. Like a real one, it measures its motors (`reading`), not its tip.
/// Backlash, hysteresis and drift act between the two and affect only `trueJoints`, which
/// determines the contact with the cell.
class SimulatedManipulator : public ManipulatorDevice {
 public:
  SimulatedManipulator(const ManipulatorGeometry& geometry, const SimulatedManipulatorConfig& config);

  ManipulatorAbilities abilities() const override;
  void limitSpeed(const Eigen::Vector3d&) override {}  ///< the geometry contains the limits
  void follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) override;
  void moveTo(const Eigen::Vector3d& joints, double speed) override;
  void stop() override;  ///< brakes with the axes' acceleration
  void clearFault() override;
  void step(double time) override;  ///< the first call only initializes the clock
  State state() const override { return fault_.empty() ? State::kReady : State::kFault; }
  std::string reason() const override { return fault_; }
  std::optional<Reading> reading() const override { return Reading{motors_, motor_velocity_}; }
  bool moving() const override;

  /// Brakes and ignores commands until clearFault().
  /// @pre `reason` is not empty
  void injectFault(const std::string& reason);

  /// True tip position, as joint positions (m) of an ideal device.
  const Eigen::Vector3d& trueJoints() const { return tip_; }

 private:
  enum class Mode { kFollow, kMove, kStop };
  void stepSetpoint(double dt);
  void stepMotors(double dt);
  void stepTip(double dt);

  ManipulatorGeometry geometry_;
  SimulatedManipulatorConfig config_;
  Mode mode_ = Mode::kStop;
  std::string fault_;
  std::optional<double> time_;  ///< s
  AxesMotion setpoint_;
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();            ///< m, of moveTo
  double speed_ = 0;                                          ///< m/s, of moveTo
  Eigen::Vector3d motors_ = Eigen::Vector3d::Zero();          ///< m
  Eigen::Vector3d motor_velocity_ = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d after_backlash_ = Eigen::Vector3d::Zero();  ///< m, after the backlash
  std::array<Hysteresis, 3> hysteresis_;
  Eigen::Vector3d drift_ = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d tip_ = Eigen::Vector3d::Zero();    ///< m
  std::mt19937_64 random_;
};

}  // namespace microinjection
