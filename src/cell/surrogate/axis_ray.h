#pragma once

#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Converged equilibria of the cell's section for a tip that moves down on the axis to `depths` (m,
/// ascending). They go deeper than in space, where the cell can buckle sideways. Each depth has the
/// result of the finest mesh that reaches it; depths that no mesh reaches are left out.
std::vector<TrainingSample> solveAxis(const Scene& scene, const std::vector<double>& depths);

}  // namespace microinjection
