#include "cell/model/converged_tongue.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>

#include "base/errors.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

/// Of a tongue's length, relative, that no finer mesh takes away: an eightfold contact stiffness shortens it by 1
/// to 2.4 parts in ten thousand.
constexpr double kMethodError = 2.5e-4;

/// P2-P1: the volume that flows into the bore is the far field's, whose error falls with the second order there, and
/// with the first of P2-P0.
CellProblem<2> problemAt(const Scene& scene, double level) {
  return CellProblem<2>(scene, makeSceneMesh<2>(scene, level), ElementKind::kP2P1);
}

void check(const Scene& scene, const std::vector<double>& pressures) {
  scene.requireContinuum("suction");
  if (!scene.holding_pipette.mouth)
    throw ConfigError("holding_pipette/mouth: is missing: inner_radius, outer_radius, edge_radius and pressure");
  for (const double pressure : pressures) {
    if (std::isfinite(pressure) && pressure <= 0) continue;
    std::ostringstream message;
    message << "pressure = " << pressure << " Pa: must be finite and at most 0, as suction is";
    throw ConfigError(message.str());
  }
}

/// From the weakest suction to the strongest, on which the path stays.
std::vector<std::size_t> rising(const std::vector<double>& pressures) {
  std::vector<std::size_t> order(pressures.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return pressures[a] > pressures[b]; });
  return order;
}

}  // namespace

std::vector<TonguePoint> convergedTongues(const Scene& scene, const std::vector<double>& pressures,
                                          const ConvergedTongueConfig& config,
                                          const std::function<void(double, std::size_t)>& report) {
  check(scene, pressures);
  const std::vector<std::size_t> order = rising(pressures);
  std::vector<TonguePoint> points(pressures.size());
  std::vector<std::optional<double>> before(pressures.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].held.pressure = pressures[i];
  for (double level = 0; level <= config.finest; ++level) {
    CellProblem<2> problem = problemAt(scene, level);
    std::size_t solved = 0;
    bool done = true;
    for (const std::size_t i : order) {
      TonguePoint& point = points[i];
      if (const LoadPath::Result result = problem.hold(pressures[i]); !result.converged) {
        for (std::size_t k = solved; k < order.size(); ++k) points[order[k]].reason = result.reason;
        break;
      }
      ++solved;
      point.reason.clear();
      point.held = problem.held();
      point.level = level;
      if (before[i]) {
        point.converged = true;
        point.error_estimate = std::abs(point.held.tongue_length / *before[i] - 1) + kMethodError;
      }
      before[i] = point.held.tongue_length;
      done = done && point.error_estimate <= config.tolerance;
    }
    if (report) report(level, solved);
    if (done && solved > 0 && level > 0) break;
  }
  for (TonguePoint& point : points) {
    if (!point.converged && point.reason.empty())
      point.reason = "only the finest mesh has a solution: its error is not known";
  }
  return points;
}

std::vector<double> tongueCurve(const Scene& scene, const std::vector<double>& suctions, double level) {
  check(scene, {});
  CellProblem<2> problem = problemAt(scene, level);
  std::vector<double> lengths;
  for (const double suction : suctions) {
    if (!problem.hold(-suction * scene.cell.material().young_modulus).converged) break;
    lengths.push_back(problem.held().tongue_length / scene.radius());
  }
  return lengths;
}

}  // namespace microinjection
