#pragma once

#include <cell_microinjection/CalibrateAction.h>
#include <geometry_msgs/PoseStamped.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <optional>
#include <string>

#include "nodes/bus/goal_node.h"
#include "nodes/imaging/tip_watch.h"
#include "vision/calibration/calibrate.h"
#include "vision/calibration/calibration_run.h"
#include "vision/calibration/drift_watch.h"

namespace microinjection {

/// Calibrates the camera against the manipulator, and watches the calibration.
///
/// In:  vision/state, /needle/measured_cp, /needle/operating_state, /controller/operating_state
/// Out: /needle/servo_cp during a run; the action calibration/calibrate (Calibrate), the service
///      calibration/rezero (Trigger), calibration/undo (Trigger)
///
/// Parameters: config/calibration.yaml
///
/// The needle is streamed at pattern/speed. So it stops when this node ends or hangs, and the
/// micromanipulator keeps its limits and obstacles. A run needs a needle that is ENABLED and clear of
/// the cell, and a controller that is DISABLED: two nodes must not command it. Any command to the
/// needle from elsewhere ends the run.
class CalibrationNode : public GoalNode<cell_microinjection::CalibrateAction> {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range, or the file of the last
  /// calibration cannot be read.
  explicit CalibrationNode(Bus& bus);

 private:
  struct Parameters {
    std::string file;            ///< of the calibration; empty: in $XDG_DATA_HOME
    double input_timeout = 0.5;  ///< s
    CalibrationConfig calibration;

    static Parameters read(const Bus& bus);
  };

  void begin(const Goal& goal) override;
  Result end(bool success) override;
  void step() override;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) override;

  std::string refusal() const;       ///< why no run may begin; empty: it may
  std::string interruption() const;  ///< why a run must not go on; empty: it may
  CalibrationInput input() const;
  void complete();
  void stream(const ros::Time& now);
  /// Writes a calibration that replaces the present one. @throws WriteError, and nothing has changed
  void store(const CameraCalibration& calibration);
  void take(const CameraCalibration& calibration);
  std::string utcNow() const;  ///< the date and time for files; in virtual time those of the bus
  void rezero(std_srvs::Trigger::Response& response);
  void undo(std_srvs::Trigger::Response& response);
  void watchDrift(const SeenTip& tip);

  Parameters parameters_;
  TipWatch watch_;
  std::optional<CameraCalibration> calibration_;
  std::optional<CameraCalibration> replaced_;  ///< by the last calibration or re-zero of this session
  std::optional<Play> play_;                   ///< of the needle, by the calibration's backlash
  DriftWatch drift_;
  DriftReport drift_report_;
  std::unique_ptr<CalibrationRun> run_;
  Eigen::Vector3d setpoint_ = Eigen::Vector3d::Zero(), goal_ = Eigen::Vector3d::Zero();  ///< m, of the run
  Eigen::Vector2i images_ = Eigen::Vector2i::Zero();  ///< px, their size when the run began
  std::string commanded_;                             ///< to the needle, from elsewhere, during the run

  Publisher<geometry_msgs::PoseStamped> setpoints_;
  Subscription commands_;
  BusHandle rezero_, undo_;
};

}  // namespace microinjection
