#include "cell/surrogate/training_ray.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
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

constexpr double kLevels[] = {-1, 0, 1};

/// Displacement (m; away from the axis, along it) of the section's outline as a function of the
/// angle (rad) from the pole.
using Outline = std::map<double, Eigen::Vector2d>;

Outline outline(const CellProblem<2>& problem) {
  Outline result;
  const QuadraticMesh<2>& mesh = problem.body().mesh();
  for (const auto& facet : mesh.facets) {
    if (facet.layer != 0) continue;
    for (int node : facet.nodes) {
      result[std::atan2(mesh.nodes[node][0], mesh.nodes[node][1])] = problem.state().segment<2>(2 * node);
    }
  }
  return result;
}

Eigen::Vector2d interpolate(const Outline& outline, double angle) {
  const auto next = outline.upper_bound(angle);
  if (next == outline.begin()) return next->second;
  const auto last = std::prev(next);
  if (next == outline.end()) return last->second;
  const double share = (angle - last->first) / (next->first - last->first);
  return (1 - share) * last->second + share * next->second;
}

Eigen::VectorXf turned(const Outline& outline, const Eigen::VectorXd& surface) {
  Eigen::VectorXf result(surface.size());
  for (Eigen::Index i = 0; i + 2 < surface.size(); i += 3) {
    const Eigen::Vector3d x = surface.segment<3>(i);
    const double away = x.head<2>().norm();
    const Eigen::Vector2d moved = interpolate(outline, std::atan2(away, x.z()));
    const Eigen::Vector2d side = away > 0 ? Eigen::Vector2d(moved[0] / away * x.head<2>()) : Eigen::Vector2d::Zero();
    result.segment<3>(i) =
        Eigen::Vector3f(static_cast<float>(side.x()), static_cast<float>(side.y()), static_cast<float>(moved[1]));
  }
  return result;
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

std::vector<TrainingSample> solveAxis(const Scene& scene, const std::vector<double>& depths) {
  Scene axial = SurrogatePlan::elastic(scene);
  axial.needle.offset.setZero();
  const Eigen::VectorXd surface = SurfaceGrid::standard().nodes(scene.radius(), 0);
  std::vector<TrainingSample> samples;
  for (const double level : kLevels) {
    CellProblem<2> problem(axial, makeSceneMesh<2>(axial, level), ElementKind::kP2P0);
    for (std::size_t i = 0; i < depths.size(); ++i) {
      const IndentationSolution solution = problem.solve(-depths[i] * Eigen::Vector3d::UnitZ());
      if (!solution.converged) break;
      if (i == samples.size()) samples.emplace_back();
      samples[i].displacement = solution.tip_displacement;
      samples[i].force = solution.force;
      samples[i].surface = turned(outline(problem), surface);
    }
  }
  return samples;
}

}  // namespace microinjection
