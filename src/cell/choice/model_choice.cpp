#include "cell/choice/model_choice.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/bytes.h"
#include "base/cpu_time.h"
#include "cell/model/contact_frame.h"
#include "cell/model/converged_force.h"
#include "cell/model/live_cell.h"
#include "cell/model/p1_cell.h"
#include "cell/model/similarity.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

constexpr double kDepths[] = {0.02, 0.05, 0.1, 0.15};  ///< over the diameter, at which a live cell is compared
constexpr double kFinestSection = 1;                   ///< level
constexpr int kFigures = 2;                            ///< increase it when a live cell or its measurement changes
constexpr int kTimedSteps = 2000;
constexpr double kSmallMove = 0.01;  ///< over the depth, of the timed solution

std::string describe(const ModelFigures& model) {
  char text[160];
  std::snprintf(text, sizeof(text), "%s: %.2g %% force error, %.3g us a force", model.name.c_str(),
                100 * model.force_error, 1e6 * model.time);
  return text;
}

/// The figures also depend on the live cell, unlike surrogate data: on its mesh, and on its model,
/// which differs if the same elastic cell is viscoelastic (see makeLiveCell).
std::string figuresDescription(const Scene& scene, const std::string& name) {
  const SurrogatePlan plan = SurrogatePlan::plan(scene, SurrogateRange::standard(scene));
  std::ostringstream out;
  out << plan.description(scene) << " figures " << kFigures << ' ' << name << " on " << std::hexfloat
      << rounded(scene.meshSize() / scene.radius()) << ' ' << scene.mesh.refinement.zone << ' '
      << scene.mesh.refinement.density << ' ' << scene.mesh.stretch
      << (P1Cell::refusals(scene).empty() ? " linear" : " swept");
  return out.str();
}

/// A file for each live cell of the same surrogate cell.
std::string figuresFile(const Scene& scene, const std::string& name) {
  const SurrogatePlan plan = SurrogatePlan::plan(scene, SurrogateRange::standard(scene));
  const std::string folder = surrogateFolder(scene, plan);
  return folder.empty() ? "" : folder + "/figures_" + name + '_' + contentHash(figuresDescription(scene, name));
}

}  // namespace

ModelChoice chooseModel(const Scene::Requirements& requirements, std::vector<ModelFigures> models) {
  std::sort(models.begin(), models.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  const double allowed = 1 / requirements.rate;
  const ModelFigures* chosen = nullptr;
  ModelChoice choice;
  for (const ModelFigures& model : models) {
    if (model.time > allowed) continue;
    choice.meets = model.force_error <= requirements.force_error;
    if (choice.meets || chosen == nullptr || model.force_error < chosen->force_error) chosen = &model;
    if (choice.meets) break;
  }
  if (chosen == nullptr) chosen = &models.front();
  choice.name = chosen->name;
  char needed[160];
  std::snprintf(needed, sizeof(needed), "%s (allowed: %.2g %% and %.3g us)",
                choice.meets ? "is the cheapest that meets both requirements" : "NO model meets both requirements",
                100 * requirements.force_error, 1e6 * allowed);
  choice.reason = choice.name + ' ' + needed;
  for (const ModelFigures& model : models) choice.reason += "; " + describe(model);
  return choice;
}

ModelFigures measureLiveCell(const Scene& scene) {
  Scene axial = scene;
  axial.needle.offset.setZero();
  const auto cell = makeLiveCell(axial);  // throws if no live cell can serve the scene
  Indenting indenting;
  for (double depth : kDepths) indenting.depths.push_back(depth * scene.cell.diameter());
  ConvergedForceConfig config;
  config.finest = kFinestSection;
  const std::vector<ForcePoint> truth = ConvergedForce(axial, indenting, config).solve();
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const auto live = cell->path(cell->contactAt(axial.radius() * up, up));
  const auto solve = [&](double depth) {
    IndentationSolution solution;
    do {
      solution = live->follow({-depth * up, 0, std::nullopt, 0});
    } while (solution.converged && solution.tip_displacement.z() != -depth);
    return solution;
  };
  ModelFigures figures;
  figures.name = "live";
  figures.force_error = 0;
  std::vector<double> times;
  for (const ForcePoint& point : truth) {
    if (!point.converged) continue;
    solve((1 - kSmallMove) * point.depth);
    const IndentationSolution solution = solve(point.depth);
    if (!solution.converged) {
      figures.force_error = std::numeric_limits<double>::infinity();
      break;
    }
    times.push_back(solution.cpu_time);
    figures.force_error = std::max(figures.force_error, std::abs(solution.force.z() / point.force.z() - 1));
  }
  if (times.empty()) {
    figures.force_error = std::numeric_limits<double>::infinity();
  } else {
    figures.time = *std::max_element(times.begin(), times.end());
  }
  return figures;
}

ModelFigures measureSurrogate(const Scene& scene, const std::shared_ptr<const SurrogateData>& cell) {
  SurrogateContact contact(scene, cell);
  std::vector<double> times(kTimedSteps);
  const Eigen::Vector3d touch = ContactFrame::at(scene, ContactFrame::offsetFor(scene, 0.4))->origin;
  for (int i = 0; i < kTimedSteps; ++i) {
    const double phase = 0.01 * i, depth = 0.5 * cell->range.depth * (1 - std::cos(phase));
    const double start = threadCpuTime();
    contact.step(touch + Eigen::Vector3d(0, 0.5 * cell->range.lateral * std::sin(3 * phase), -depth));
    times[i] = threadCpuTime() - start;
  }
  std::sort(times.begin(), times.end());
  return {"surrogate", cell->common_error, times[times.size() * 99 / 100]};
}

void saveFigures(const Scene& scene, const ModelFigures& figures) {
  const std::string path = figuresFile(scene, figures.name);
  if (path.empty()) return;
  ByteWriter writer;
  writer.number(figures.force_error);
  writer.number(figures.time);
  writeCacheFile(path, figuresDescription(scene, figures.name), writer.bytes());
}

CacheRead<ModelFigures> loadFigures(const Scene& scene, const std::string& name) {
  const std::string path = figuresFile(scene, name);
  const CacheRead<std::string> read = readCacheFile(path, figuresDescription(scene, name));
  if (!read) return read.failure<ModelFigures>();
  if (read.content->size() != 2 * sizeof(double)) return damagedCache<ModelFigures>(path, "it is not of two numbers");
  ByteReader reader(*read.content);
  ModelFigures figures;
  figures.name = name;
  figures.force_error = reader.number<double>();
  figures.time = reader.number<double>();
  // An infinite error belongs to a model without a solution.
  if (!(figures.force_error >= 0 && figures.time >= 0 && std::isfinite(figures.time))) {
    return damagedCache<ModelFigures>(path, "a figure of the model cannot be");
  }
  return {figures, CacheState::kRead, ""};
}

}  // namespace microinjection
