#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "operation/teleoperation/device_axes_fit.h"

namespace microinjection {

/// The steps in which an operator calibrates `device_axes`: begin, then one motion() when the hand
/// is at the end of right, away, up. A motion starts where the hand was at the step before. With a
/// device that springs back (rate mode) it starts at its place of begin(). Every step returns an
/// empty text, or the reason why nothing changed.
class DeviceAxesCalibration {
 public:
  using Hand = std::optional<Eigen::Vector3d>;  ///< m, the device's axes; empty: no valid position

  /// `axes` are those of the start of the session.
  DeviceAxesCalibration(std::string axes, bool springs_back) : axes_(std::move(axes)), springs_back_(springs_back) {}

  /// Starts anew. A run that is not complete is forgotten.
  std::string begin(const Hand& hand);
  /// The hand has moved along next(). The third motion changes axes().
  std::string motion(const Hand& hand);
  /// During a run: forgets its last motion, or ends a run without one. Otherwise: the axes before
  /// the last change.
  std::string undo(const Hand& hand);
  /// Ends a run without a change.
  void stop() { running_ = false; }

  bool running() const { return running_; }
  const std::string& axes() const { return axes_; }  ///< those that apply
  int changes() const { return changes_; }           ///< grows with each change of axes()
  const DeviceAxesFit& fit() const { return fit_; }  ///< of the last run
  /// What the operator does next, or what the last step has reached.
  std::string prompt() const;

 private:
  std::string axes_;
  bool springs_back_;
  bool running_ = false;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  ///< m, of the next motion
  DeviceAxesFit fit_;
  std::vector<std::string> earlier_;  ///< axes before each change
  int changes_ = 0;
};

}  // namespace microinjection
