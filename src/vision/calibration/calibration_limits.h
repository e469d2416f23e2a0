#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "vision/calibration/camera_calibration.h"

namespace microinjection {

/// What calibrate() accepts; beyond it the calibration is refused.
struct CalibrationLimits {
  std::string mirror = "any";                 ///< any, yes or no: whether the image may be mirrored
  int least_points = 12;                      ///< tips without outliers
  int least_focus_points = 7;                 ///< focus readings without outliers; with none the focus is left out
  double largest_backlash = 5e-6;             ///< m, of an axis; a move longer than it takes up the play
  double least_spread = 0.2;                  ///< 1, of the points across their longest direction over along it
  double largest_outlier_share = 0.2;         ///< 1, of the observations
  double largest_residual = 1;                ///< px rms of a coordinate, without outliers
  Eigen::Vector2d pixel_size{0.02e-6, 2e-6};  ///< m, lowest and highest
  double largest_skew = 0.1;                  ///< rad
  Eigen::Vector2d axis_ratio{0.9, 1.1};       ///< 1, lowest and highest
  double pixel_size_interval = 2e-3;          ///< 1, largest half width of the 95 % interval over the pixel size
  double angle_interval = 2e-3;               ///< rad, largest half width
  double tip_interval = 0.5;                  ///< px, largest half width
  double backlash_interval = 0.3e-6;          ///< m, largest half width, of x and z
  double focus_interval = 0.1;                ///< m/m, largest half width of focus_y

  static CalibrationLimits read(ConfigReader& reader);
  /// Throws ConfigError with all errors.
  void validate() const;
};

/// Reasons why a fitted calibration is refused; none when it is good. Each has the name, the value
/// and what is allowed.
std::vector<std::string> refusalsOf(const CameraCalibration& calibration, const CalibrationLimits& limits);

}  // namespace microinjection
