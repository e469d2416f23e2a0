#pragma once

#include <cell_microinjection/CalibrateAxes.h>
#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include <Eigen/Core>
#include <optional>
#include <string>

#include "base/background_file.h"
#include "nodes/runtime/cycle.h"
#include "operation/teleoperation/device_axes_calibration.h"

namespace microinjection {

/// The service ~calibrate_axes of the bridge (CalibrateAxes). New axes apply at once and are written
/// to a file, which a session takes as its overrides. BEGIN, and the UNDO of a change, are refused
/// while the needle follows the hand and the controller may be ENABLED.
///
/// In: /controller/operating_state (OperatingState)
class AxesService {
 public:
  /// `axes`, `springs_back`: of DeviceAxesCalibration. `file`: path; empty: device_axes.yaml of userDataFile().
  AxesService(Cycle& cycle, const std::string& axes, bool springs_back, const std::string& file);

  /// What the last step has seen: the hand (m, the device's axes; empty: invalid), and whether the
  /// needle follows it.
  void observe(const std::optional<Eigen::Vector3d>& hand, bool followed);
  /// The axes that apply.
  const std::string& axes() const { return calibration_.axes(); }
  /// Why the bridge holds the needle; empty: there is no calibration under way.
  std::string holdReason() const;
  void report(diagnostic_updater::DiagnosticStatusWrapper& status) const;

 private:
  using Service = cell_microinjection::CalibrateAxes;
  bool answer(Service::Request& request, Service::Response& response);
  std::string act(int action);
  std::string followsReason() const;
  void write();

  DeviceAxesCalibration calibration_;
  BackgroundFile file_;
  std::optional<Eigen::Vector3d> hand_;
  bool followed_ = false;
  std::string controller_state_;  ///< empty: not heard of
  int kept_changes_ = 0;          ///< of the calibration, that are in the file
  BusHandle server_;
  Subscription controller_;
};

}  // namespace microinjection
