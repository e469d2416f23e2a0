#pragma once

#include <actionlib/server/simple_action_server.h>
#include <cell_microinjection/CalibrateAction.h>
#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <optional>
#include <string>

#include "nodes/imaging/tip_watch.h"
#include "nodes/runtime/master_monitor.h"
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
class CalibrationNode {
 public:
  static const char* const kHelp;
  /// @throws ConfigError when a parameter is unknown or out of range, or the file of the last
  /// calibration cannot be read.
  CalibrationNode(ros::NodeHandle node, ros::NodeHandle private_node);
  void run();

 private:
  struct Parameters {
    std::string file;            ///< of the calibration; empty: in $XDG_DATA_HOME
    double input_timeout = 0.5;  ///< s
    CalibrationConfig calibration;
  };
  static Parameters readParameters(const ros::NodeHandle& private_node);

  void onGoal();
  std::string refusal() const;       ///< why no run may begin; empty: it may
  std::string interruption() const;  ///< why a run must not go on; empty: it may
  void step();
  CalibrationInput input() const;
  void end();
  void fail(const std::string& reason);
  void stream(const ros::Time& now);
  /// Writes a calibration that replaces the present one. @throws WriteError, and nothing has changed
  void store(const CameraCalibration& calibration);
  void take(const CameraCalibration& calibration);
  bool rezero(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool undo(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void watchDrift(const SeenTip& tip);
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  Parameters parameters_;
  TipWatch watch_;
  std::optional<CameraCalibration> calibration_;
  std::optional<CameraCalibration> replaced_;  ///< by the last calibration or re-zero of this session
  std::optional<Play> play_;                   ///< of the needle, by the calibration's backlash
  DriftWatch drift_;
  DriftReport drift_report_;
  std::unique_ptr<CalibrationRun> run_;
  Eigen::Vector3d setpoint_ = Eigen::Vector3d::Zero(), goal_ = Eigen::Vector3d::Zero();  ///< m, of the run
  std::string commanded_;  ///< to the needle, from elsewhere, during the run

  MasterMonitor master_{true};
  ros::Publisher setpoints_;
  ros::Subscriber commands_;
  ros::ServiceServer rezero_, undo_;
  actionlib::SimpleActionServer<cell_microinjection::CalibrateAction> action_;
  diagnostic_updater::Updater diagnostics_;
  ros::SteadyTimer timer_;
};

}  // namespace microinjection
