#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/bytes.h"
#include "cell/surrogate/surrogate_plan.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// The forces of a solved path. A family keeps them beside its fits: another fit then needs no new
/// solutions, which take hours.
struct PathForces {
  Eigen::Matrix3Xf forces;   ///< at the points of the path, as far as it was solved
  bool ended_early = false;  ///< before its target
};

std::vector<PathForces> pathForces(const std::vector<TrainingResult>& results);

/// The results of the plan's paths again, without surfaces. Throws std::runtime_error when the paths
/// are not those of the plan.
std::vector<TrainingResult> trainingResults(const SurrogatePlan& plan, const std::vector<PathForces>& paths);

void write(ByteWriter& writer, const std::vector<PathForces>& paths);
/// Throws std::runtime_error when a size or a value cannot be.
std::vector<PathForces> readPathForces(ByteReader& reader);

}  // namespace microinjection
