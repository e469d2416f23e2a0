#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Converged equilibria of the cell's section for a tip that moves down on the axis to `depths` (m,
/// ascending). They go deeper than in space, where the cell can buckle sideways. Each depth has the
/// result of the finest mesh that reaches it; depths that no mesh reaches are left out. `surface`:
/// nodes (m, xyz) at rest on the cell's sphere, whose displacements are added to the samples.
std::vector<TrainingSample> solveAxis(const Scene& scene, const std::vector<double>& depths,
                                      const Eigen::VectorXd& surface);

}  // namespace microinjection
