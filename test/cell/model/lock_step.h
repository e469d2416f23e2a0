#pragma once

#include <Eigen/Core>

namespace microinjection {

constexpr double kStep = 1e-3;                           // s
const Eigen::Vector3d kAxis = Eigen::Vector3d::UnitZ();  // of the pipette, out of the cell

}  // namespace microinjection
