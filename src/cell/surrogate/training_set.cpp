#include "cell/surrogate/training_set.h"
#include "cell/surrogate/axis_ray.h"

#include <algorithm>
#include <stdexcept>

#include "cell/surrogate/mesh_correction.h"

namespace microinjection {
namespace {

constexpr double kLeastShare = 0.2;  ///< of a path: with less, the cell is not worth serving
constexpr int kDeepSamples = 14;     ///< on the axis, below the depth of the range elsewhere

bool straightOnAxis(const TrainingRay& ray) { return ray.angle == 0 && ray.target.head<2>().isZero(0); }

/// Adds the section's results, which are more accurate and deeper, for the straight path on the
/// axis.
void addAxis(const Scene& scene, const std::vector<double>& depths, TrainingSet& samples) {
  for (const TrainingSample& sample : solveAxis(scene, depths)) {
    samples.forces.push_back(sample);
    samples.surfaces.push_back(sample);
    samples.range.axis_depth = -sample.displacement.z();
  }
}

}  // namespace

TrainingSet TrainingSet::gather(const Scene& scene, const SurrogatePlan& plan,
                                const std::vector<TrainingResult>& results) {
  const std::vector<TrainingRay>& rays = plan.rays;
  const auto better = betterForces(plan.scales, rays, results);
  TrainingSet samples;
  samples.range = reachedRange(plan, results);
  samples.range.axis_depth = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays[i].level != kCoarseLevel) continue;
    if (straightOnAxis(rays[i])) {
      addAxis(scene, axisDepths(plan.range, rays[i]), samples);
      continue;
    }
    samples.forces.insert(samples.forces.end(), better[i].begin(), better[i].end());
    samples.surfaces.insert(samples.surfaces.end(), results[i].samples.begin(), results[i].samples.end());
  }
  if (!(samples.range.axis_depth > 0)) {
    throw std::runtime_error("on the axis the cell's section has no solution at any depth");
  }
  return samples;
}

std::vector<double> axisDepths(const SurrogateRange& range, const TrainingRay& straight) {
  std::vector<double> depths;
  for (int i = 0; i < straight.points; ++i) depths.push_back(-straight.at(i).z());
  for (int i = 1; i <= kDeepSamples; ++i) {
    depths.push_back(range.depth + (range.axis_depth - range.depth) * i / kDeepSamples);
  }
  return depths;
}

SurrogateRange reachedRange(const SurrogatePlan& plan, const std::vector<TrainingResult>& results) {
  double share = 1;
  for (std::size_t i = 0; i < results.size(); ++i) {
    // The coarse mesh continues where the fine one has no solution.
    if (plan.rays[i].level != kCoarseLevel || results[i].reason.empty()) continue;
    const double reached = results[i].samples.empty() ? 0 : results[i].samples.back().displacement.norm();
    share = std::min(share, reached / plan.rays[i].target.norm());
  }
  if (share < kLeastShare)
    throw std::runtime_error("a path ends before a fifth of its length (see above): not prepared");
  SurrogateRange range = plan.range;
  range.depth *= share;
  range.lateral *= share;
  return range;
}

}  // namespace microinjection
