#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Equilibria of the cell's section for a tip that comes down on the axis to `depths` (m, ascending): converged, and
/// deeper than in space, where the cell can give way to a side. Of each depth that of the finest of a few meshes that
/// reaches it; none for depths that no mesh does. `surface`: nodes (m, xyz) at rest whose displacement is wanted, on
/// the cell's sphere.
std::vector<TrainingSample> solveAxis(const Scene& scene, const std::vector<double>& depths,
                                      const Eigen::VectorXd& surface);

}  // namespace microinjection
