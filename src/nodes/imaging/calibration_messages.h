#pragma once

#include <cell_microinjection/CalibrateResult.h>

#include <string>

#include "vision/calibration/camera_calibration.h"

namespace microinjection {

/// Pixel size, angle and residual with their 95 % intervals, for people.
std::string describe(const CameraCalibration& calibration);

/// The result of a calibration, without its success.
cell_microinjection::CalibrateResult toResult(const CameraCalibration& calibration);

}  // namespace microinjection
