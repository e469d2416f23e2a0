#pragma once

#include <vector>

#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Share of the largest force that is added to the magnitude in a sample's weight.
constexpr double kFitFloor = 0.0025;

/// Largest magnitude of the samples' forces, N.
double largestForce(const std::vector<TrainingSample>& samples);

/// Least-squares fit of the coefficients: -dE/du to the samples' forces, with errors relative to
/// each force.
void fitEnergy(EnergyExpansion& expansion, const std::vector<TrainingSample>& samples);

/// Least squares with a penalty on each coefficient, 1e-4 relative to its effect on the values.
Eigen::VectorXd solveRegularised(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

}  // namespace microinjection
