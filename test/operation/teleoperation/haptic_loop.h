#pragma once

#include <Eigen/Core>

namespace microinjection {

constexpr double kStep = 1e-3;        // s
constexpr double kResolution = 2e-5;  // m, of the device's encoders

/// Places of hand and needle at the start, m.
const Eigen::Vector3d kHand(0.1, 0, 0.05), kNeedle(1e-6, 2e-6, 60e-6);

}  // namespace microinjection
