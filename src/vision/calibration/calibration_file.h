#pragma once

#include <string>

#include "vision/calibration/camera_calibration.h"

namespace microinjection {

/// File of the last calibration: `configured`, or where that is empty cell_microinjection/calibration.yaml in
/// $XDG_DATA_HOME, else in ~/.local/share.
std::string calibrationPath(const std::string& configured);

/// YAML text of a calibration: every value with its unit, its 95 % interval and its covariances.
std::string toYaml(const CameraCalibration& calibration);

/// Writes the file atomically. Throws WriteError and then leaves an existing file as it was.
void writeCalibration(const std::string& path, const CameraCalibration& calibration);

/// Throws ConfigError, which names the file and each key that is missing, unknown or out of range.
/// A file that ends too early is refused: its last key says that it is complete.
CameraCalibration readCalibration(const std::string& path);

/// Same, from YAML text; `origin` names it in messages.
CameraCalibration calibrationFromYaml(const std::string& text, const std::string& origin);

}  // namespace microinjection
