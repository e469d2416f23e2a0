// Pushes a needle tip into a cell and writes the force at each depth; see --help.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "cell/cell_model.h"
#include "cell/converged_force.h"
#include "cell/scene.h"
#include "cell/tensegrity_cell.h"
#include "commands/indent_arguments.h"

namespace microinjection {
namespace {

constexpr int kConverged = 0, kBadUsage = 2, kNotConverged = 3, kNotAccurate = 4;

/// Pushed straight down, a deeper point continues from the last one, which lies on its way; any other starts afresh.
ForcePoint solveLive(LiveIndentation& indentation, double depth, const Indenting& indenting) {
  constexpr double kEver = std::numeric_limits<double>::infinity();
  const auto start = std::chrono::steady_clock::now();
  const Eigen::Vector2d& lateral = indenting.lateral;
  const bool on_the_way = lateral.isZero(0) && -indentation.tipDisplacement().z() <= depth;
  if (!on_the_way) indentation.reset();
  const Eigen::Vector3d target(lateral.x(), lateral.y(), -depth);
  const double way = (target - indentation.tipDisplacement()).norm();
  IndentationSolution solution = indentation.solve(target, way > 0 && indenting.speed ? way / *indenting.speed : kEver);
  if (solution.converged && indenting.hold > 0) solution = indentation.solve(target, indenting.hold);
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

std::shared_ptr<const LiveCell> liveCell(const Scene& scene) {
  if (!scene.cell.tensegrity) {
    const auto cell = std::make_shared<const CellModel>(scene);
    std::fprintf(stderr, "indent: live model, %zu vertices, %zu tetrahedra\n", cell->mesh().vertices.size(),
                 cell->mesh().tetrahedra.size());
    return cell;
  }
  const auto cell = std::make_shared<const TensegrityCell>(scene);
  const TensegrityStructure& structure = cell->structure();
  std::fprintf(stderr, "indent: tensegrity, %zu nodes, %d tetrahedra; prestress %.4g N, unbalanced %.2g N\n",
               structure.nodePlaces().size(), structure.struts().elementCount(), structure.form().prestress,
               structure.form().residual);
  return cell;
}

std::vector<ForcePoint> live(const Scene& scene, const Indenting& indenting) {
  const auto cell = liveCell(scene);
  const Eigen::Vector2d& offset = scene.needle.offset;
  const TipPatch patch = cell->patchAt({offset.x(), offset.y(), scene.radius()}, Eigen::Vector3d::UnitZ());
  std::fprintf(stderr, "indent: %zu vertices under the tip\n", patch.vertices.size());
  const std::unique_ptr<LiveIndentation> indentation = cell->indentation(patch);
  std::vector<ForcePoint> points;
  for (double depth : indenting.depths) points.push_back(solveLive(*indentation, depth, indenting));
  return points;
}

std::vector<ForcePoint> converged(const Scene& scene, const IndentArguments& arguments) {
  ConvergedForce solver(scene, arguments.indenting, arguments.converged);
  std::fprintf(stderr, "indent: %s, %s elements, tolerance %.3g\n", solver.axisymmetric() ? "axisymmetric" : "spatial",
               elementName(arguments.converged.element).c_str(), arguments.converged.tolerance);
  return solver.solve([&](const LevelReport& report) {
    std::fprintf(stderr, "indent: mesh %g, %zu elements, %d unknowns, %.1f s:", report.level, report.elements,
                 report.unknowns, report.wall_time);
    for (double force : report.forces) std::fprintf(stderr, " %.5g", 1e6 * force);
    std::fprintf(stderr, " uN\n");
  });
}

void tell(const ForcePoint& point, double tolerance) {
  if (!point.converged) {
    std::fprintf(stderr, "indent: depth %.4g um: not converged: %s\n", 1e6 * point.depth, point.reason.c_str());
    return;
  }
  std::fprintf(stderr, "indent: depth %.4g um: force (%.5g, %.5g, %.5g) uN", 1e6 * point.depth, 1e6 * point.force.x(),
               1e6 * point.force.y(), 1e6 * point.force.z());
  if (std::isfinite(point.error_estimate)) {
    const bool missed = point.error_estimate > tolerance;
    std::fprintf(stderr, ", error about %.2g %%%s", 100 * point.error_estimate,
                 missed ? ": not the tolerance that is asked for" : "");
  }
  std::fprintf(stderr, "\n");
}

std::string csvRow(const ForcePoint& point) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d force = point.converged ? point.force : Eigen::Vector3d::Constant(nan);
  char row[200];
  std::snprintf(row, sizeof(row), "%.9g,%.9g,%.9g,%.9g,%.6f,%d,%.3g\n", point.depth, force.x(), force.y(), force.z(),
                point.wall_time, point.converged ? 1 : 0, point.error_estimate);
  return row;
}

int run(int argc, char** argv) {
  const std::optional<IndentArguments> parsed = parseIndentArguments(argc, argv);
  if (!parsed) return kConverged;
  const IndentArguments& arguments = *parsed;
  const Scene scene = loadScene(arguments.scene);
  const std::vector<ForcePoint> points =
      arguments.live || (scene.cell.tensegrity && arguments.converged.model == ConvergedForceConfig::Model::kAuto)
          ? live(scene, arguments.indenting)
          : converged(scene, arguments);
  std::string table = "depth_m,force_x_N,force_y_N,force_z_N,wall_s,converged,error_estimate\n";
  int status = kConverged;
  for (const ForcePoint& point : points) {
    tell(point, arguments.converged.tolerance);
    table += csvRow(point);
    const bool missed =
        arguments.tolerance_given && !arguments.live && point.error_estimate > arguments.converged.tolerance;
    if (!point.converged) {
      status = kNotConverged;
    } else if (missed && status == kConverged) {
      status = kNotAccurate;
    }
  }
  if (arguments.csv == "-") {
    std::cout << table << std::flush;
  } else {
    writeFileAtomically(arguments.csv, table);
  }
  return status;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  try {
    return microinjection::run(argc, argv);
  } catch (const std::exception& exception) {
    std::cerr << "indent: " << exception.what() << '\n';
    return microinjection::kBadUsage;
  }
}
