#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct TremorFilterConfig {
  double cutoff = 0;  ///< Hz, of the low-pass; 0: none

  static TremorFilterConfig read(ConfigReader reader);
};

/// Low-pass of the hand's position against physiological tremor (8 to 12 Hz; voluntary motion is below 2 to 5 Hz):
/// Butterworth of second order,
///     x'' + sqrt(2) w x' + w^2 x = w^2 u, w = 2 pi cutoff,
/// by the trapezoidal rule. Slow motion comes late by sqrt(2) / w = 0.225 / cutoff, which is exact for the sampled
/// filter, too: 6 Hz takes a 10 Hz tremor to 34 % and costs 38 ms.
///
/// None by default: a scale of 1e-3 makes 0.1 mm of tremor 0.1 um at the needle, and 38 ms in the force's loop would
/// need b > 60 N/m * 38 ms = 2.3 N s/m from the hand before the passivity controller has to act. With a scale of 1e-2
/// it is worth it.
class TremorFilter {
 public:
  explicit TremorFilter(const TremorFilterConfig& config);

  /// Starts at rest here (m).
  void reset(const Eigen::Vector3d& position);
  /// The filtered position (m), dt (s) after the one before.
  Eigen::Vector3d step(const Eigen::Vector3d& position, double dt);
  double delay() const;  ///< s, of slow motion

 private:
  double frequency_;                                    ///< rad/s
  Eigen::Vector3d input_ = Eigen::Vector3d::Zero();     ///< m, the one before
  Eigen::Vector3d output_ = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< m/s, of the output
};

}  // namespace microinjection
