#pragma once

#include <string>
#include <vector>

#include "benchmark/common/simulated_needle.h"
#include "vision/calibration/calibrate.h"

namespace microinjection {

inline const TravelBox kTestBox{Eigen::Vector3d::Constant(-200e-6), Eigen::Vector3d::Constant(200e-6)};
inline const std::string kTestDate = "2025-03-04T05:06:07Z";

/// Waypoints of a pattern about the origin, with focus readings or without.
inline std::vector<CalibrationWaypoint> testWaypoints(bool focus = false) {
  CalibrationPatternConfig config;
  config.depth = focus ? 20e-6 : 0;
  const CalibrationPlan plan =
      planCalibration(config, Eigen::Vector3d::Zero(), Eigen::Vector3d(3e-6, 0, -2e-6), kTestBox);
  return plan.waypoints;
}

inline CalibrationSetup testSetup() { return {kTestDate, Eigen::Vector2d(695.5, 519.5), {}}; }

inline SimulatedNeedle needleOf(const SimulatedNeedleConfig& truth) { return {truth, Eigen::Vector3d(3e-6, 0, -2e-6)}; }

/// Calibration of a needle that was moved on the test pattern.
inline CalibrationOutcome calibrateNeedle(SimulatedNeedle& needle, bool focus = false,
                                          const CalibrationLimits& limits = {}) {
  return calibrate(needle.observe(testWaypoints(focus)), limits, testSetup());
}

/// The truth, in the calibration's origin. The play of an axis y that did not move is a part of the tip's place.
inline CalibrationVector<double> trueValue(const SimulatedNeedleConfig& truth, const SimulatedNeedle& needle,
                                           const CameraCalibration& calibration) {
  Eigen::Vector3d offset = calibration.origin - truth.origin;
  if (!calibration.estimated[kDepthDriftX]) offset.y() = needle.place().y() - truth.origin.y();
  CalibrationVector<double> value = truth.value;
  value.segment<2>(kTipU) = tipPixel<double>(truth.value, truth.mirrored, offset);
  value[kFocusZero] = tipFocus<double>(truth.value, offset);
  return value;
}

}  // namespace microinjection
