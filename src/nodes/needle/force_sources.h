#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "hardware/sensor/force_sensor.h"
#include "hardware/sensor/overload_latch.h"
#include "hardware/sensor/serial_force_sensor.h"
#include "hardware/serial/serial_port.h"
#include "nodes/runtime/cycle.h"
#include "nodes/runtime/frames.h"

namespace microinjection {

/// Source of the force sensor's readings.
class ForceSource {
 public:
  struct Signal {
    Eigen::VectorXd values;  ///< (axial, lateral) in the sensor's frame (N), or force (N) and torque (N m) at the tip
    ros::Time stamp;
    geometry_msgs::WrenchStamped raw;  ///< in the sensor's frame
  };

  virtual ~ForceSource() = default;

  virtual int size() const = 0;  ///< of Signal::values
  /// Largest Signal::values allowed for calibration loads.
  virtual Eigen::VectorXd range() const = 0;
  /// The new reading of this step. Empty: none; invalidReason() has the reason if the source is
  /// invalid.
  virtual std::optional<Signal> read(const Cycle::Tick& tick) = 0;
  virtual bool overloaded() const = 0;
  virtual std::string overloadText() const = 0;  ///< see OverloadLatch
  virtual void reset() = 0;
  virtual bool saturated() const = 0;
  virtual void report(diagnostic_updater::DiagnosticStatusWrapper&) const {}

  /// Why there is no valid reading; empty when there is one.
  const std::string& invalidReason() const { return invalid_reason_; }

 protected:
  std::string invalid_reason_;
};

/// A simulated sensor loaded with the predicted force.
class SimulatedForceSource : public ForceSource {
 public:
  /// `tip_from_sensor`: pose of the sensor in needle_tip.
  SimulatedForceSource(Cycle& cycle, double timeout, const ForceSensorConfig& config, std::string frame,
                       const Eigen::Isometry3d& tip_from_sensor);

  int size() const override { return 2; }
  Eigen::VectorXd range() const override { return range_; }
  std::optional<Signal> read(const Cycle::Tick& tick) override;
  bool overloaded() const override { return model_.overloaded(); }
  std::string overloadText() const override { return model_.overloadText(); }
  void reset() override { model_.reset(); }
  bool saturated() const override { return model_.saturated(); }

 private:
  ForceSensor model_;
  Eigen::Vector2d range_;  ///< N
  std::string frame_;
  Eigen::Matrix3d sensor_from_tip_;
  Input<geometry_msgs::WrenchStamped>& force_;
  Input<geometry_msgs::PoseStamped>& needle_;
};

/// A real sensor's voltages on a serial line.
class SerialForceSource : public ForceSource {
 public:
  SerialForceSource(const SerialPortConfig& port, const VoltReadingConfig& config, const Eigen::Vector2d& overload,
                    double timeout, std::string frame);

  int size() const override { return 2; }
  Eigen::VectorXd range() const override { return overload_.limit(); }
  std::optional<Signal> read(const Cycle::Tick& tick) override;
  bool overloaded() const override { return overload_.latched(); }
  std::string overloadText() const override { return overload_.text(); }
  void reset() override { overload_.reset(); }
  bool saturated() const override { return device_.reading() && device_.reading()->saturated; }
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const override;

 private:
  SerialForceSensor device_;
  OverloadLatch overload_;
  double timeout_;  ///< s
  std::string frame_;
  unsigned seen_ = 0;  ///< good lines up to the last step
};

/// A wrench measured by another node, in any frame of tf; its force at the tip is checked for
/// overload.
class TopicForceSource : public ForceSource {
 public:
  TopicForceSource(Cycle& cycle, double timeout, const Eigen::Vector2d& overload);

  int size() const override { return 6; }
  Eigen::VectorXd range() const override { return Eigen::VectorXd::Zero(size()); }  ///< calibrated by its own node
  std::optional<Signal> read(const Cycle::Tick& tick) override;
  bool overloaded() const override { return overload_.latched(); }
  std::string overloadText() const override { return overload_.text(); }
  void reset() override { overload_.reset(); }
  bool saturated() const override { return false; }

 private:
  FrameListener frames_;
  OverloadLatch overload_;
  Input<geometry_msgs::WrenchStamped>& wrench_;
};

}  // namespace microinjection
