#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vision/calibration/calibration_limits.h"

namespace microinjection {

/// One waypoint of a calibration, in the order of the moves. A waypoint without observation is
/// needed as well: it determines where the backlash leaves the tip.
struct TipObservation {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m, of the motors, at rest; reached in one straight move
  std::optional<Eigen::Vector2d> pixel;                ///< px, where the tip was seen
  Eigen::Matrix2d covariance = 0.04 * Eigen::Matrix2d::Identity();  ///< px^2; scaled by the residuals of the fit
  std::optional<double> focus;                                      ///< m, best focus of the tip
  double focus_deviation = 0.3e-6;                                  ///< m; scaled by the residuals of the fit
};

/// Observations that a fit can use: those before which each moved axis took up its play.
struct CalibrationData {
  std::vector<TipObservation> waypoints;
  std::vector<int> pixels, focus;      ///< indices of waypoints
  std::vector<Eigen::Vector3i> sides;  ///< of each waypoint: direction of each axis' last motion, 0 before it
  std::array<bool, 3> moved{};         ///< axes that move in the data
  std::array<bool, kCalibrationParameters> estimated{};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< m, middle of the used positions
};

/// Sorts out what can be used. Adds to `refusals` what forbids a fit: values that are not finite,
/// too few points, points on one line, an axis approached from one direction only.
CalibrationData prepareData(const std::vector<TipObservation>& waypoints, const CalibrationLimits& limits,
                            std::vector<std::string>& refusals);

/// Parameters in the neighbourhood of the fit, from a linear model
///     pixel = a + J q + K side,  K = -J diag(backlash) / 2
/// with the least sum of distances, which a few outliers cannot move. None when it is singular.
struct CalibrationStart {
  CalibrationVector<double> value = CalibrationVector<double>::Zero();
  bool mirrored = false;
};
std::optional<CalibrationStart> linearStart(const CalibrationData& data);

}  // namespace microinjection
