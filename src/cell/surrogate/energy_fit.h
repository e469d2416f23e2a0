#pragma once

#include <vector>

#include "cell/surrogate/energy_expansion.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

struct EnergyFitConfig {
  double floor = 0.0025;         ///< of the largest force: smaller ones count as if they were larger by it
  double regularisation = 1e-4;  ///< of each coefficient, relative to what it does to the forces
};

/// N, size.
double largestForce(const std::vector<TrainingSample>& samples);

/// Coefficients by which -dE/du is nearest to the samples' forces, each relative to its size.
void fitEnergy(EnergyExpansion& expansion, const std::vector<TrainingSample>& samples,
               const EnergyFitConfig& config = {});

}  // namespace microinjection
