#include "cell/surrogate/axis_ray.h"

#include <algorithm>
#include <cmath>

#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"
#include "cell/surrogate/surface_grid.h"

namespace microinjection {
namespace {

constexpr double kLevels[] = {-1, 0, 1};

Eigen::VectorXf turned(const SectionOutline& outline, const Eigen::VectorXd& surface) {
  Eigen::VectorXf result(surface.size());
  for (Eigen::Index i = 0; i + 2 < surface.size(); i += 3) {
    const Eigen::Vector3d x = surface.segment<3>(i);
    const double away = x.head<2>().norm();
    const Eigen::Vector2d moved = displacementAt(outline, std::atan2(away, x.z()));
    const Eigen::Vector2d side = away > 0 ? Eigen::Vector2d(moved[0] / away * x.head<2>()) : Eigen::Vector2d::Zero();
    result.segment<3>(i) =
        Eigen::Vector3f(static_cast<float>(side.x()), static_cast<float>(side.y()), static_cast<float>(moved[1]));
  }
  return result;
}

}  // namespace

SectionOutline sectionOutline(const CellProblem<2>& problem) {
  SectionOutline result;
  const QuadraticMesh<2>& mesh = problem.body().mesh();
  for (const auto& facet : mesh.facets) {
    if (facet.layer != 0) continue;
    for (int node : facet.nodes) {
      result[std::atan2(mesh.nodes[node][0], mesh.nodes[node][1])] = problem.state().segment<2>(2 * node);
    }
  }
  return result;
}

Eigen::Vector2d displacementAt(const SectionOutline& outline, double angle) {
  const auto next = outline.upper_bound(angle);
  if (next == outline.begin()) return next->second;
  const auto last = std::prev(next);
  if (next == outline.end()) return last->second;
  const double share = (angle - last->first) / (next->first - last->first);
  return (1 - share) * last->second + share * next->second;
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
      samples[i].surface = turned(sectionOutline(problem), surface);
    }
  }
  return samples;
}

}  // namespace microinjection
