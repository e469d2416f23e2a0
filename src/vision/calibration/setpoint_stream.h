#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Set-points that bring a needle to a place through a controller. After a hold, and so after a late
/// set-point, such a controller counts them from where the needle is: an offset remains between the two.
/// This stream finds the offset when the needle rests beside its goal, and takes it up.
class SetpointStream {
 public:
  /// `position`: m, of the needle at rest. `arrived`: m, distance from the goal at which it has arrived.
  SetpointStream(const Eigen::Vector3d& position, double arrived, double now);

  /// The next set-point (m) on the way to `goal`, by up to `reach` (m).
  Eigen::Vector3d advance(const Eigen::Vector3d& goal, double reach);
  /// Whether the needle, at `position` (m), is at the goal of the last set-point. Call it once a step.
  bool arrived(const Eigen::Vector3d& position, double now);
  /// The set-point is at rest and the needle is not there: it is held, or about to arrive.
  bool waits() const { return waits_; }

 private:
  double arrived_;
  Eigen::Vector3d setpoint_, goal_;
  Eigen::Vector3d offset_ = Eigen::Vector3d::Zero();  ///< m, of a set-point from where it brings the needle
  double since_;                                      ///< s, when the set-point came to rest
  bool waits_ = false;
};

}  // namespace microinjection
