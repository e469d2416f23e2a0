#pragma once

#include <optional>
#include <string>
#include <vector>

#include "vision/calibration/calibration_data.h"
#include "vision/calibration/camera_calibration.h"

namespace microinjection {

/// What a calibration stores beside its fit.
struct CalibrationSetup {
  std::string date;                                           ///< UTC, YYYY-MM-DDTHH:MM:SSZ
  Eigen::Vector2d reference_pixel = Eigen::Vector2d::Zero();  ///< px, the image's centre
  std::vector<TipRecord> tips;                                ///< earlier tips of this holder
  Eigen::Vector2i image_size = Eigen::Vector2i::Zero();       ///< px, width and height
};

struct CalibrationOutcome {
  std::optional<CameraCalibration> calibration;  ///< none when it was refused
  std::vector<std::string> refusals;             ///< name, value and what is allowed
  std::vector<int> outliers;                     ///< indices of observations that were left out
  std::string warning;                           ///< the tip lies outside the holder's history
};

/// Fits the observations by non-linear least squares (Ceres): first with Cauchy's loss, then
/// without loss on those within 4.5 deviations of that fit, both with the play of each axis
/// replayed over all moves. The covariance is scaled by the residuals, tips and focus readings
/// apart (variance components). `limits` must be valid.
CalibrationOutcome calibrate(const std::vector<TipObservation>& waypoints, const CalibrationLimits& limits,
                             const CalibrationSetup& setup);

}  // namespace microinjection
