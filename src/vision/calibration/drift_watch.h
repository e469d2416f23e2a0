#pragma once

#include <Eigen/Core>
#include <deque>
#include <string>

#include "base/config_reader.h"
#include "vision/calibration/camera_calibration.h"

namespace microinjection {

struct DriftWatchConfig {
  double threshold = 0.5e-6;   ///< m, of the tip in the image plane; beyond it is a drift
  int window = 20;             ///< observations
  double confidence = 0.9999;  ///< 1, of a verdict

  static DriftWatchConfig read(ConfigReader& reader);
};

enum class DriftVerdict {
  kTooFew,   ///< the window is not yet full
  kWithin,   ///< the drift is below the threshold
  kUnsure,   ///< noise leaves both open
  kDrifted,  ///< the drift is above the threshold
};

struct DriftReport {
  DriftVerdict verdict = DriftVerdict::kTooFew;
  Eigen::Vector2d drift = Eigen::Vector2d::Zero();  ///< px, seen minus expected
  double distance = 0;                              ///< m
  double half_width = 0;                            ///< m, of the distance at the confidence
  std::string text;                                 ///< one sentence with numbers
};

/// Compares where the tip is expected and where it is seen. The drift is the median of the last
/// differences, which single bad detections do not move. Its variance is
///     pi / 2 max(stated, scatter) / n + that of the expected pixel,
/// the last from the calibration, because the window does not average it.
class DriftWatch {
 public:
  explicit DriftWatch(const DriftWatchConfig& config) : config_(config) {}

  /// Adds an observation of the tip at `place` (m) and reports on the window. An observation that
  /// is not finite, or has no covariance, is ignored.
  DriftReport add(const CameraCalibration& calibration, const Eigen::Vector3d& place, const Eigen::Vector2d& seen,
                  const Eigen::Matrix2d& covariance);
  void reset() { window_.clear(); }  ///< after a new calibration or rezero

 private:
  struct Difference {
    Eigen::Vector2d pixel;       ///< px
    Eigen::Matrix2d covariance;  ///< px^2
  };
  Eigen::Matrix2d varianceOf(const Eigen::Matrix2d& expected) const;
  Eigen::Vector2d medianOfWindow() const;

  DriftWatchConfig config_;
  std::deque<Difference> window_;
};

}  // namespace microinjection
