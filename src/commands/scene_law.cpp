#include "commands/scene_law.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "cell/identification/interpolated_law.h"
#include "cell/material/material_parameter.h"
#include "commands/indent_models.h"

namespace microinjection {
namespace {

constexpr int kDepths = 16;
constexpr double kTime = 100;                       ///< s after which no finer mesh is begun
constexpr double kOnAxis = 0.005, kInSpace = 0.03;  ///< tolerances of `indent`
constexpr std::size_t kFewest = 4;                  ///< depths with a solution
constexpr double kBoundOverMedian = 2.9;            ///< 95 % over the median size of a normal error
constexpr double kNear = 0.2;                       ///< of two values' logarithms: one of them is enough
constexpr double kReaches = 0.8;                    ///< of the deepest solution's depth: others are left out

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

void setParameter(Scene& scene, const MaterialParameter& parameter, double value) {
  for (Scene::Layer& layer : scene.cell.layers) {
    if (layer.material.model == parameter.model) layer.material.*parameter.value = value;
  }
}

/// A scene solved at some depths.
struct SolvedScene {
  std::vector<double> depths, forces;  ///< m; N/Pa
  double bound = 0;                    ///< relative error of the forces
  bool live = false;

  /// Throws ConfigError when too few depths have a solution.
  TableLaw law() const {
    if (depths.size() < kFewest) {
      throw ConfigError("--model solution: the scene has a solution at only " + std::to_string(depths.size()) +
                        " of the depths");
    }
    char text[160];
    std::snprintf(text, sizeof(text), "%s of the scene to %.3g um, force error below %.2g %%",
                  live ? "live model" : "solution", 1e6 * depths.back(), 100 * bound);
    return {text, depths, forces, bound / kBoundOverMedian};
  }
};

SolvedScene solveScene(const Scene& scene, const IndentArguments& arguments) {
  const double modulus = scene.cell.material().young_modulus, deepest = arguments.indenting.depths.back();
  SolvedScene solved;
  solved.live = arguments.live;
  for (const ForcePoint& point : solveIndentation(scene, arguments)) {
    if (!point.converged || !(point.force.z() > 0)) continue;
    solved.depths.push_back(point.depth);
    solved.forces.push_back(point.force.z() / modulus);
    if (point.depth > 0.25 * deepest && std::isfinite(point.error_estimate)) {
      solved.bound = std::max(solved.bound, point.error_estimate);
    }
  }
  return solved;
}

/// The scene solved with its own value of a parameter, that of the outermost layer that has it, and with those of
/// freeMaterialParameters() that are not near it.
std::shared_ptr<ElasticLaw> solveValues(Scene scene, const std::string& free, IndentArguments arguments) {
  const std::vector<MaterialParameter>& all = materialParameters();
  const MaterialParameter& parameter =
      *std::find_if(all.begin(), all.end(), [&](const MaterialParameter& each) { return free == each.name; });
  std::optional<double> own;
  std::string models;
  for (const Scene::Layer& layer : scene.cell.layers) {
    if (!own && layer.material.model == parameter.model) own = layer.material.*parameter.value;
    models += (models.empty() ? "" : ", ") + layer.material.model;
  }
  if (!own) {
    throw ConfigError("--free " + free + ": needs a layer of model " + parameter.model + "; the scene has " + models);
  }
  const auto solveWith = [&](double value) {
    setParameter(scene, parameter, value);
    std::fprintf(stderr, "identify: %s = %g\n", parameter.name, value);
    return solveScene(scene, arguments);
  };
  const TableLaw fine = solveWith(*own).law();
  arguments.converged.time = 0;  // two meshes
  const TableLaw coarse = solveWith(*own).law();
  std::map<double, TableLaw> laws{{*own, fine}};
  double deepest = fine.deepest();
  Eigen::VectorXd none;
  for (const double value : freeMaterialParameters().at(free)) {
    if (std::abs(std::log(value / *own)) < kNear) continue;
    SolvedScene solved = solveWith(value);
    if (solved.depths.size() < kFewest) continue;
    for (std::size_t i = 0; i < solved.depths.size(); ++i) {
      solved.forces[i] *= fine.force(solved.depths[i], none).force / coarse.force(solved.depths[i], none).force;
    }
    laws.emplace(value, TableLaw(fine.description(), solved.depths, solved.forces, fine.error()));
    deepest = std::max(deepest, solved.depths.back());
  }
  for (auto each = laws.begin(); each != laws.end();) {
    each = each->second.deepest() < kReaches * deepest ? laws.erase(each) : std::next(each);
  }
  if (laws.size() < 2) {
    throw ConfigError("--free " + free + ": only one value of it has a solution to the record's depth");
  }
  return std::make_shared<InterpolatedLaw>(free, *own, laws);
}

}  // namespace

const std::map<std::string, std::vector<double>>& freeMaterialParameters() {
  static const std::map<std::string, std::vector<double>> values = {{"ogden_exponent", {1, 2, 3.5, 6, 10, 17, 30}},
                                                                    {"gent_limit", {0.1, 0.3, 1, 3, 10, 30, 100, 1e4}}};
  return values;
}

std::shared_ptr<ElasticLaw> solveSceneLaw(const Scene& scene, bool live, double deepest, const std::string& free) {
  requireProportional(scene);
  IndentArguments arguments;
  arguments.live = live;
  arguments.converged.time = kTime;
  arguments.converged.tolerance = scene.needle.offset.isZero(0) ? kOnAxis : kInSpace;
  for (int k = 1; k <= kDepths; ++k) {
    arguments.indenting.depths.push_back(std::pow(static_cast<double>(k) / kDepths, 2) * deepest);
  }
  if (!free.empty()) return solveValues(scene, free, arguments);
  return std::make_shared<TableLaw>(solveScene(scene, arguments).law());
}

}  // namespace microinjection
