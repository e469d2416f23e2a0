#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <vector>

#include "vision/calibration/calibration_data.h"
#include "vision/calibration/calibration_pattern.h"

namespace microinjection {

/// Truth behind a calibration, for tests and benchmarks.
struct SimulatedNeedleConfig {
  CalibrationVector<double> value = CalibrationVector<double>::Zero();  ///< pixel size and axis ratio must be set
  bool mirrored = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, place that is seen at (tip_u, tip_v)
  double noise = 0.2;                                ///< px rms, of each coordinate
  double focus_noise = 0.1e-6;                       ///< m rms
  double outlier_share = 0;                          ///< 1, of the observations
  double outlier_size = 20;  ///< px, an outlier is uniform within this of the tip, in each coordinate
  std::uint64_t seed = 1;
};

/// A truth drawn at random: pixel size 0.1 to 0.2 um, any angle, mirrored or not, skew within 0.05 rad, axis ratio
/// within 3 %, drift of axis y within 2 %, 2 um of backlash, tip near pixel (696, 520).
SimulatedNeedleConfig drawnNeedle(std::uint64_t seed);

/// A needle on a manipulator with backlash, and the camera that sees its tip with noise. The play
/// starts at a random place.
class SimulatedNeedle {
 public:
  SimulatedNeedle(const SimulatedNeedleConfig& config, const Eigen::Vector3d& position);

  void moveTo(const Eigen::Vector3d& position);            ///< m, of the motors
  const Eigen::Vector3d& place() const { return place_; }  ///< m, true place of the tip
  Eigen::Vector2d truePixel() const;
  Eigen::Vector2d seenPixel();
  double seenFocus();  ///< m
  double normal();     ///< standard normal deviate, the same with every standard library
  double uniform();    ///< in [0, 1)

  /// Moves through the plan and observes where it says so.
  std::vector<TipObservation> observe(const std::vector<CalibrationWaypoint>& waypoints);

 private:
  SimulatedNeedleConfig config_;
  std::mt19937_64 random_;
  Eigen::Vector3d place_;
};

}  // namespace microinjection
