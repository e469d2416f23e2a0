#pragma once

#include <vector>

#include "surrogate/energy_expansion.h"
#include "surrogate/training_ray.h"

namespace microinjection {

struct EnergyFitConfig {
  double floor = 0.01;           ///< of the largest force: smaller ones count as if they were so large
  double regularisation = 1e-5;  ///< of each coefficient, relative to what it does to the forces
};

/// Coefficients by which -dE/du is nearest to the samples' forces, each relative to its size.
void fitEnergy(EnergyExpansion& expansion, const std::vector<TrainingSample>& samples,
               const EnergyFitConfig& config = {});

/// Relative errors of the force, |-dE/du - f| / |f|, of the samples whose force is above `floor` of the largest.
std::vector<double> forceErrors(const EnergyExpansion& expansion, const std::vector<TrainingSample>& samples,
                                double floor);

}  // namespace microinjection
