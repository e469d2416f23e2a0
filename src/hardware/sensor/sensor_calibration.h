#pragma once

#include <Eigen/Core>
#include <string>

namespace microinjection {

/// Tare and gain of a force sensor: force = gain (reading - tare), for each axis of a reading.
struct SensorCalibration {
  Eigen::VectorXd tare;  ///< N
  Eigen::MatrixXd gain;
  int points = 0;       ///< known forces that gave the gain; 0: it is not measured
  double residual = 0;  ///< N rms, of the points from the fit
};

/// Returns an empty text, or the reason why no sensor has this gain: it is not finite, or changes the size of a force
/// more than a hundredfold. A sensor outside of that is not wired or not configured as in its file.
std::string gainRefusal(const Eigen::MatrixXd& gain);

/// YAML text with units; its last key says that it is complete.
std::string toYaml(const SensorCalibration& calibration);

/// Throws ConfigError, which names the file and each key that is missing, unknown or out of range.
SensorCalibration readSensorCalibration(const std::string& path);

}  // namespace microinjection
