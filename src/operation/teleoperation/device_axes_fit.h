#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// Finds `device_axes` (FrameMappingConfig) from three motions of the hand along the view's axes:
/// right (x), away (y), up (z). Each motion is a difference of two positions in the device's axes.
class DeviceAxesFit {
 public:
  static constexpr double kShortest = 10e-3;  ///< m, shortest motion that is accepted
  static constexpr double kWidest = 30;       ///< degrees, largest angle between a motion and the device's nearest axis

  /// Takes the motion (m) along next(). Returns an empty text, or the reason for a refusal. It
  /// refuses a motion that is short, oblique, or along the axis of an earlier one, and a third one
  /// that mirrors the set. A refused motion changes nothing. @pre not complete()
  std::string add(const Eigen::Vector3d& motion);
  /// Forgets the last motion, if there is one.
  void removeLast();

  bool complete() const { return motions_.size() == 3; }
  int motions() const { return static_cast<int>(motions_.size()); }
  /// "right", "away" or "up"; empty when complete.
  std::string next() const;
  /// For example "x -z y". @pre complete()
  std::string axes() const;
  /// Largest angle (rad) between a motion and its axis of the device.
  double angleToAxis() const;
  /// Largest difference (rad) of the angle between two motions from a right angle.
  double angleToSquare() const;

 private:
  std::vector<Eigen::Vector3d> motions_;  ///< m, along the view's x, y, z
};

}  // namespace microinjection
