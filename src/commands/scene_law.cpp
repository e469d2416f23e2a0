#include "commands/scene_law.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "base/errors.h"
#include "commands/indent_models.h"

namespace microinjection {
namespace {

constexpr int kDepths = 16;
constexpr double kTime = 100;                       ///< s after which no finer mesh is begun
constexpr double kOnAxis = 0.005, kInSpace = 0.03;  ///< tolerances of `indent`
constexpr std::size_t kFewest = 4;                  ///< depths with a solution
constexpr double kBoundOverMedian = 2.9;            ///< 95 % over the median size of a normal error

void requireProportional(const Scene& scene) {
  scene.requireContinuum("--model solution");
  scene.requireGlued("--model solution, whose force has to be proportional to the modulus");
  const bool tension = std::any_of(scene.cell.layers.begin(), scene.cell.layers.end(),
                                   [](const Scene::Layer& layer) { return layer.surface_tension != 0; });
  if (tension || scene.needle.contact.adhesion_energy > 0) {
    throw ConfigError(
        "--model solution: surface_tension and adhesion_energy must be 0: with them, the force is not proportional "
        "to the modulus");
  }
}

}  // namespace

std::shared_ptr<ElasticLaw> solveSceneLaw(const Scene& scene, bool live, double deepest) {
  requireProportional(scene);
  IndentArguments arguments;
  arguments.live = live;
  arguments.converged.time = kTime;
  arguments.converged.tolerance = scene.needle.offset.isZero(0) ? kOnAxis : kInSpace;
  for (int k = 1; k <= kDepths; ++k) {
    arguments.indenting.depths.push_back(std::pow(static_cast<double>(k) / kDepths, 2) * deepest);
  }
  const double modulus = scene.cell.material().young_modulus;
  std::vector<double> depths, forces;
  double bound = 0;
  for (const ForcePoint& point : solveIndentation(scene, arguments)) {
    if (!point.converged || !(point.force.z() > 0)) continue;
    depths.push_back(point.depth);
    forces.push_back(point.force.z() / modulus);
    if (point.depth > 0.25 * deepest && std::isfinite(point.error_estimate)) {
      bound = std::max(bound, point.error_estimate);
    }
  }
  if (depths.size() < kFewest) {
    throw ConfigError("--model solution: the scene has a solution at only " + std::to_string(depths.size()) +
                      " of the depths");
  }
  char text[160];
  std::snprintf(text, sizeof(text), "%s of the scene to %.3g um, force error below %.2g %%",
                live ? "live model" : "solution", 1e6 * depths.back(), 100 * bound);
  return std::make_shared<TableLaw>(text, depths, forces, bound / kBoundOverMedian);
}

}  // namespace microinjection
