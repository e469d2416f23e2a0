#include "cell/surrogate/training_ray.h"

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "base/bytes.h"
#include "cell/model/cell_problem.h"
#include "cell/model/contact_frame.h"
#include "cell/model/scene_mesh.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

constexpr ElementKind kElement = ElementKind::kP2P0;

Scene at(const Scene& scene, double angle) {
  Scene result = SurrogatePlan::elastic(scene);
  result.needle.offset = ContactFrame::offsetFor(scene, angle);
  return result;
}

/// Whether the ray is in the plane of contact point and cell axis, so that the scene has its mirror
/// symmetry.
bool inPlane(const TrainingRay& ray) { return ray.target.y() == 0; }

/// Difference between a result and its ray; empty when they fit.
std::string mismatch(const TrainingResult& result, const TrainingRay& ray) {
  const int count = static_cast<int>(result.samples.size());
  if (count > ray.points || (count < ray.points && result.reason.empty()))
    return "not all places of its path are there";
  const Eigen::Index expected = ray.level == kCoarseLevel ? 3 * SurfaceGrid::standard().nodeCount() : 0;
  for (int i = 0; i < count; ++i) {
    const TrainingSample& sample = result.samples[i];
    if (sample.angle != ray.angle || sample.displacement != ray.at(i)) return "it is of another path";
    if (sample.surface.size() != expected) return "its surface is of another grid";
  }
  return "";
}

}  // namespace

TrainingResult solveRay(const Scene& scene, const TrainingRay& ray) {
  const Scene local = at(scene, ray.angle);
  const bool half = inPlane(ray);
  CellProblem<3> problem(local, half ? makeHalfSceneMesh(local, ray.level) : makeSceneMesh<3>(local, ray.level),
                         kElement, half ? Symmetry::kMirror : Symmetry::kNone);
  std::optional<GridInterpolation> surface;
  if (ray.level == kCoarseLevel) surface.emplace(problem.body().mesh(), ray.angle, half);
  TrainingResult result;
  for (int i = 0; i < ray.points; ++i) {
    const Eigen::Vector3d displacement = ray.at(i);
    const IndentationSolution solution = problem.solve(displacement);
    if (!solution.converged) {
      result.reason = solution.reason;
      break;
    }
    result.samples.push_back({ray.angle, displacement, solution.force, {}});
    if (surface) result.samples.back().surface = surface->displacement(problem.state());
  }
  return result;
}

std::string encode(const TrainingResult& result) {
  ByteWriter writer;
  writer.array(result.reason);
  writer.number<std::uint64_t>(result.samples.size());
  for (const TrainingSample& sample : result.samples) {
    writer.number(sample.angle);
    for (int i = 0; i < sample.displacement.size(); ++i) writer.number(sample.displacement[i]);
    for (int i = 0; i < sample.force.size(); ++i) writer.number(sample.force[i]);
    writer.array(sample.surface);
  }
  return writer.bytes();
}

TrainingResult decodeTraining(const std::string& bytes) {
  ByteReader reader(bytes);
  TrainingResult result;
  reader.array(result.reason);
  const auto count = reader.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    TrainingSample sample;
    sample.angle = reader.number<double>();
    for (int k = 0; k < sample.displacement.size(); ++k) sample.displacement[k] = reader.number<double>();
    for (int k = 0; k < sample.force.size(); ++k) sample.force[k] = reader.number<double>();
    reader.array(sample.surface);
    if (!std::isfinite(sample.angle) || !sample.displacement.allFinite() || !sample.force.allFinite() ||
        !sample.surface.allFinite()) {
      throw std::runtime_error("a value is not finite");
    }
    result.samples.push_back(std::move(sample));
  }
  if (!reader.atEnd()) throw std::runtime_error("there is more than was written");
  return result;
}

CacheRead<TrainingResult> loadTraining(const std::string& path, const std::string& description,
                                       const TrainingRay& ray) {
  const CacheRead<std::string> read = readCacheFile(path, description);
  if (!read) return read.failure<TrainingResult>();
  try {
    TrainingResult result = decodeTraining(*read.content);
    const std::string difference = mismatch(result, ray);
    if (!difference.empty()) return damagedCache<TrainingResult>(path, difference);
    return {std::move(result), CacheState::kRead, ""};
  } catch (const std::runtime_error& error) {
    return damagedCache<TrainingResult>(path, error.what());
  }
}

}  // namespace microinjection
