#pragma once

#include <vector>

#include "cell/model/scene.h"
#include "cell/surrogate/surrogate_plan.h"
#include "cell/surrogate/training_ray.h"

namespace microinjection {

/// Equilibria that a surrogate cell is fitted to: forces as converged as possible, surfaces of the
/// coarse mesh and, deep on the axis, of the section.
struct TrainingSet {
  std::vector<TrainingSample> forces, surfaces;
  SurrogateRange range;  ///< that the paths reached

  /// Of the results of plan.rays. On the axis it uses forces of the section, elsewhere those
  /// of the fine mesh or corrected ones of the coarse mesh. Throws std::runtime_error when the section
  /// has no solution, and as reachedRange.
  static TrainingSet gather(const Scene& scene, const SurrogatePlan& plan, const std::vector<TrainingResult>& results);
};

/// Depths (m, ascending) of the samples on the axis: of all points of the straight path, whether it
/// reached them or not, and below it.
std::vector<double> axisDepths(const SurrogateRange& range, const TrainingRay& straight);

/// The range that all coarse paths reached. Depth and lateral range are smaller than planned by the
/// share of the path that ended first; `axis_depth` is as planned. Throws std::runtime_error when
/// that share is below a fifth.
SurrogateRange reachedRange(const SurrogatePlan& plan, const std::vector<TrainingResult>& results);

}  // namespace microinjection
