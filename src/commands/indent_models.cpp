#include "commands/indent_models.h"

#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>

#include "cell/model/biomembrane.h"
#include "cell/model/indentation.h"
#include "cell/model/p1_cell.h"
#include "cell/model/tensegrity_cell.h"

namespace microinjection {
namespace {

/// Text of at most 200 characters, as std::printf makes it.
template <typename... Values>
std::string line(const char* format, Values... values) {
  char text[201];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// A deeper point straight below the last one continues from it. Any other point starts from rest.
/// `solve` moves `path` to a displacement (m).
template <typename Path, typename Solve>
ForcePoint solveLive(Path& path, double depth, const Eigen::Vector2d& lateral, const Solve& solve) {
  const auto start = std::chrono::steady_clock::now();
  const bool on_path = lateral.isZero(0) && -path.tipDisplacement().z() <= depth;
  if (!on_path) path.reset();
  const IndentationSolution solution = solve(Eigen::Vector3d(lateral.x(), lateral.y(), -depth));
  ForcePoint point;
  point.depth = depth;
  point.converged = solution.converged;
  char reached[80];
  std::snprintf(reached, sizeof(reached), "; reached (%.4g, %.4g, %.4g) um", 1e6 * solution.tip_displacement.x(),
                1e6 * solution.tip_displacement.y(), 1e6 * solution.tip_displacement.z());
  point.reason = solution.reason + reached;
  point.force = solution.force;
  point.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return point;
}

TipPatch tipPatch(const DiscContactCell& cell, const Report& report) {
  const Eigen::Vector2d& offset = cell.scene().needle.offset;
  const TipPatch patch = cell.patchAt({offset.x(), offset.y(), cell.scene().radius()}, Eigen::Vector3d::UnitZ());
  report(line("%s; %zu vertices under the tip", cell.description().c_str(), patch.vertices.size()));
  return patch;
}

std::vector<ForcePoint> live(const Scene& scene, const Indenting& indenting, const Report& report) {
  const auto cell = std::make_shared<const P1Cell>(scene);
  Indentation indentation(cell, tipPatch(*cell, report));
  std::vector<ForcePoint> points;
  const auto solve = [&](const Eigen::Vector3d& target) { return indentation.solve(target); };
  for (double depth : indenting.depths) points.push_back(solveLive(indentation, depth, indenting.lateral, solve));
  return points;
}

std::vector<ForcePoint> tensegrity(const Scene& scene, const Indenting& indenting, const Report& report) {
  const auto cell = std::make_shared<const TensegrityCell>(scene);
  const std::unique_ptr<TensegrityIndentation> path = cell->indentation(tipPatch(*cell, report));
  const auto solve = [&](const Eigen::Vector3d& target) {
    constexpr double kUntilRelaxed = std::numeric_limits<double>::infinity();
    const double distance = (target - path->tipDisplacement()).norm();
    const IndentationSolution moved =
        path->solve(target, distance > 0 && indenting.speed ? distance / *indenting.speed : kUntilRelaxed);
    return moved.converged && indenting.hold > 0 ? path->solve(target, indenting.hold) : moved;
  };
  std::vector<ForcePoint> points;
  for (double depth : indenting.depths) {
    // After the straight path has ended, each further search takes seconds. It ends at the same
    // point for deeper points.
    const bool straight = indenting.lateral.isZero(0) && !points.empty();
    if (straight && !points.back().converged && depth >= points.back().depth) {
      points.push_back(points.back());
      points.back().depth = depth;
      points.back().wall_time = 0;
    } else {
      points.push_back(solveLive(*path, depth, indenting.lateral, solve));
    }
  }
  return points;
}

std::vector<ForcePoint> membrane(const Scene& scene, const Indenting& indenting, const Report& report) {
  const MaterialConfig& material = scene.cell.material();
  const Biomembrane model(material.young_modulus, material.poisson_ratio, scene.needle.tip.radius,
                          *scene.cell.biomembrane);
  report(line("membrane of %.4g um, dimple of %.4g um", 1e6 * scene.cell.biomembrane->thickness,
              1e6 * scene.cell.biomembrane->dimple_radius));
  std::vector<ForcePoint> points;
  for (const double depth : indenting.depths) {
    ForcePoint& point = points.emplace_back();
    point.depth = depth;
    point.converged = true;
    point.force.z() = model.force(depth);
    if (model.strain(depth) > 0.1) {
      report(line("depth %.4g um: the membrane's strain is %.2g, too large for this model", 1e6 * depth,
                  model.strain(depth)));
    }
  }
  return points;
}

std::vector<ForcePoint> converged(const Scene& scene, const IndentArguments& arguments, const Report& report) {
  ConvergedForce solver(scene, arguments.indenting, arguments.converged);
  report(line("%s, %s elements, tolerance %.3g", solver.axisymmetric() ? "axisymmetric" : "spatial",
              elementName(arguments.converged.element).c_str(), arguments.converged.tolerance));
  return solver.solve([&](const LevelReport& level) {
    std::string text = line("mesh %g, %zu elements, %d unknowns, %.1f s:", level.level, level.elements, level.unknowns,
                            level.wall_time);
    for (double force : level.forces) text += line(" %.5g", 1e6 * force);
    report(text + " uN");
  });
}

}  // namespace

void printProgress(const std::string& line) { std::fprintf(stderr, "indent: %s\n", line.c_str()); }

std::vector<ForcePoint> solveIndentation(const Scene& scene, const IndentArguments& arguments, const Report& report) {
  arguments.requireFit(scene);
  if (arguments.membrane) return membrane(scene, arguments.indenting, report);
  const bool default_model = arguments.live || arguments.converged.model == ConvergedForceConfig::Model::kAuto;
  if (scene.cell.tensegrity && default_model) return tensegrity(scene, arguments.indenting, report);
  return arguments.live ? live(scene, arguments.indenting, report) : converged(scene, arguments, report);
}

}  // namespace microinjection
