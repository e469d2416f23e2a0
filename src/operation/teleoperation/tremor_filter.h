#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

struct TremorFilterConfig {
  double cutoff = 0;  ///< Hz, of the low-pass; 0: none

  static TremorFilterConfig read(ConfigReader reader);
};

/// Low-pass of the hand's position against physiological tremor (8 to 12 Hz; voluntary motion is
/// below 2 to 5 Hz): Butterworth of second order,
///     x'' + sqrt(2) w x' + w^2 x = w^2 u, w = 2 pi cutoff,
/// by the trapezoidal rule. It delays slow motion by sqrt(2) / w = 0.225 / cutoff, which is exact
/// for the sampled filter, too: 6 Hz reduces a 10 Hz tremor to 34 % and costs 38 ms.
///
/// The default is no filter. A scale of 1e-3 turns 0.1 mm of tremor into 0.1 um at the needle, and
/// a delay of 38 ms in the force's loop requires a hand with b > 60 N/m * 38 ms = 2.3 N s/m to stay
/// passive without the passivity controller. At a scale of 1e-2 the filter pays off.
class TremorFilter {
 public:
  explicit TremorFilter(const TremorFilterConfig& config);

  /// Starts at rest at `position` (m).
  void reset(const Eigen::Vector3d& position);
  /// Returns the filtered position (m), dt (s) after the last one.
  Eigen::Vector3d step(const Eigen::Vector3d& position, double dt);
  double delay() const;  ///< s, of slow motion

 private:
  double frequency_;                                    ///< rad/s
  Eigen::Vector3d input_ = Eigen::Vector3d::Zero();     ///< m, of the last step
  Eigen::Vector3d output_ = Eigen::Vector3d::Zero();    ///< m
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< m/s, of the output
};

}  // namespace microinjection
