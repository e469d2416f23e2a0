#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct ForceLimits {
  double force = 3.0;   ///< N, the largest that the haptic device is asked for
  double rate = 100.0;  ///< N/s, the fastest that the force changes; one that would push the hand on is let go at once

  /// Keys force_limit and force_rate_limit.
  static ForceLimits read(ConfigReader& reader);
};

/// What the device is asked for: no larger than the limit, no faster than the rate, so that a puncture's drop of force
/// or another model's force does not kick the hand.
///
/// A force that lags behind may not do work that the wanted force would not do. Where the hand moves against the
/// lingering force (on in, through the punctured membrane) it dissipates, and a soft fall is good. Where the hand moves
/// with it, it would push: that part is let go at once. The rise lags the other way, with less resistance than wanted:
/// the energy that is missed is the passivity controller's business.
class ForceLimiter {
 public:
  explicit ForceLimiter(const ForceLimits& limits) : limits_(limits) {}

  /// `wanted` (N), the hand's `velocity` (m/s), dt (s); returns the force (N).
  const Eigen::Vector3d& step(const Eigen::Vector3d& wanted, const Eigen::Vector3d& velocity, double dt);
  /// At once, without a rate.
  void release() { force_.setZero(); }

 private:
  ForceLimits limits_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

}  // namespace microinjection
