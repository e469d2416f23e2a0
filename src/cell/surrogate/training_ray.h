#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/cache_file.h"
#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_plan.h"

namespace microinjection {

/// An equilibrium of the converging model, in the contact frame.
struct TrainingSample {
  double angle = 0;                                        ///< rad, of the contact point
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero();  ///< m, of the tip since first contact
  Eigen::Vector3d force = Eigen::Vector3d::Zero();         ///< N, of the cell on the needle
  Eigen::VectorXf surface;  ///< m, displacement of each node (xyz) of SurfaceGrid; coarse mesh only
};

struct TrainingResult {
  std::vector<TrainingSample> samples;  ///< in order along the ray
  std::string reason;                   ///< why the ray ended before its target; else empty
};

/// Solves along a ray, on P2-P0 elements in space. Throws as CellProblem does.
TrainingResult solveRay(const Scene& scene, const TrainingRay& ray);

std::string encode(const TrainingResult& result);
/// Throws std::runtime_error when the bytes are incomplete or a value is not finite.
TrainingResult decodeTraining(const std::string& bytes);

/// The stored result of `ray`. The state is kDamaged, too, when it belongs to another ray, or when
/// its surfaces are not of SurfaceGrid.
CacheRead<TrainingResult> loadTraining(const std::string& path, const std::string& description, const TrainingRay& ray);

/// Converged equilibria of the cell's section for a tip that moves down on the axis to `depths` (m,
/// ascending). They go deeper than in space, where the cell can buckle sideways. Each depth has the
/// result of the finest mesh that reaches it; depths that no mesh reaches are left out.
std::vector<TrainingSample> solveAxis(const Scene& scene, const std::vector<double>& depths);

}  // namespace microinjection
