#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct ForceLimits {
  double force = 3.0;   ///< N, largest force commanded to the haptic device
  double rate = 100.0;  ///< N/s, largest rate; a force that would push the hand on is removed at once

  /// Keys force_limit and force_rate_limit.
  static ForceLimits read(ConfigReader& reader);
};

/// Limits the force commanded to the device and its rate, so that the drop of force at a puncture
/// or a change of the force's model does not kick the hand.
///
/// A lagging force must not do work that the wanted force would not do. While the hand moves
/// against it (on through the punctured membrane) it dissipates, and a soft fall is good. The part
/// along the hand's motion would push the hand and is removed at once. A lagging rise renders less
/// resistance than wanted; the passivity controller handles the missing energy.
class ForceLimiter {
 public:
  explicit ForceLimiter(const ForceLimits& limits) : limits_(limits) {}

  /// Returns the force (N) for `wanted` (N), the hand's `velocity` (m/s) and dt (s).
  const Eigen::Vector3d& step(const Eigen::Vector3d& wanted, const Eigen::Vector3d& velocity, double dt);
  /// Sets the force to zero at once, without the rate limit.
  void release() { force_.setZero(); }

 private:
  ForceLimits limits_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

}  // namespace microinjection
