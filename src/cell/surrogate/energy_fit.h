#pragma once

#include <vector>

#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

struct EnergyFitConfig {
  double floor = 0.0025;         ///< share of the largest force that is added to the magnitude in a sample's weight
  double regularisation = 1e-4;  ///< of each coefficient, relative to its effect on the forces
};

/// Largest magnitude of the samples' forces, N.
double largestForce(const std::vector<TrainingSample>& samples);

/// Least-squares fit of the coefficients: -dE/du to the samples' forces, with errors relative to
/// each force.
void fitEnergy(EnergyExpansion& expansion, const std::vector<TrainingSample>& samples,
               const EnergyFitConfig& config = {});

}  // namespace microinjection
