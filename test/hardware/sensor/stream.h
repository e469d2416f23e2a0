#pragma once

#include <Eigen/Core>

#include "hardware/sensor/force_sensor.h"

namespace microinjection {

/// `count` readings of an axis (0 axial, 1 lateral) under a constant force (N), one for each sample of the converter.
inline Eigen::VectorXd stream(ForceSensor& sensor, const Eigen::Vector2d& force, double period, int count, int axis) {
  Eigen::VectorXd readings(count);
  for (double& reading : readings) reading = sensor.sample(force, period)[axis];
  return readings;
}

}  // namespace microinjection
