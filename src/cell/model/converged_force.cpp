#include "cell/model/converged_force.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <new>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "cell/contact/rounded_tip.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();  ///< s

/// Series of meshes.
struct Refinement {
  double first;  ///< level
  double step;   ///< from one level to the next
  double cost;   ///< ratio of the times of successive meshes
  double last;   ///< first level that may be the last
};
// A sharp edge needs finer meshes. In the section, where meshes cost little, two meshes that agree
// by chance do not suffice.
constexpr Refinement kDiscInSection = {0, 1, 3, 2}, kRoundedInSection = {0, 1, 3, 1};
constexpr Refinement kDiscInSpace = {-0.5, 0.5, 3, 0}, kRoundedInSpace = {-1, 0.5, 3, -0.5};

Refinement refinementOf(bool axisymmetric, const Scene::Tip& tip) {
  if (axisymmetric) return tip.rounded() ? kRoundedInSection : kDiscInSection;
  return tip.rounded() ? kRoundedInSpace : kDiscInSpace;
}

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

std::string micrometres(double metres) {
  char text[40];
  std::snprintf(text, sizeof(text), "%.4g um", 1e6 * metres);
  return text;
}

}  // namespace

void Indenting::validate() const {
  if (withdrawal.empty()) return;
  if (depths.empty() || !lateral.isZero(0)) {
    throw ConfigError("withdrawal: must be left out where lateral is not 0 or there are no depths");
  }
  double last = *std::max_element(depths.begin(), depths.end());
  for (const double depth : withdrawal) {
    if (!(depth < last)) {
      std::ostringstream message;
      message << "withdrawal: " << depth << " m must be below the depth before, " << last << " m";
      throw ConfigError(message.str());
    }
    last = depth;
  }
}

/// Equilibria on one mesh.
struct ConvergedForce::Level {
  LevelReport report;
  Forces forces;
  std::vector<double> wall_times;  ///< s
  double reached = 0;              ///< m, deepest equilibrium
  std::string reason;              ///< why it ended there
};

ConvergedForce::ConvergedForce(const Scene& scene, const Indenting& indenting, const ConvergedForceConfig& config)
    : scene_(scene), indenting_(indenting), config_(config) {
  scene_.validate();
  scene_.requireContinuum("a solution on finer and finer meshes");
  indenting_.validate();
  const bool possible = isAxisymmetric(scene) && indenting.lateral.isZero(0);
  if (config.model == ConvergedForceConfig::Model::kAxisymmetric && !possible) {
    throw ConfigError("model = axisymmetric: needle/offset and lateral must be 0; use spatial or auto");
  }
  axisymmetric_ = possible && config.model != ConvergedForceConfig::Model::kSpatial;
  if (!axisymmetric_) scene_.requireGlued("a needle beside the axis, and for model = spatial");
}

/// A swept mesh can be bent towards the contact point only up to a limit.
template <int Dim>
CellProblem<Dim> ConvergedForce::makeProblem(double level) const {
  try {
    return CellProblem<Dim>(scene_, makeSceneMesh<Dim>(scene_, level), config_.element);
  } catch (const InvertedElement& error) {
    if (Dim == 2) throw;
    std::ostringstream message;
    message << "needle/offset (its length) = " << scene_.needle.offset.norm()
            << ": the spatial mesh cannot be ordered around a needle so far out; must be at most about "
            << 0.7 * scene_.radius() << " m (0.7 of the cell's radius), or use the live model (" << error.what() << ")";
    throw ConfigError(message.str());
  }
}

/// Order of the solutions: indentation, then withdrawal.
std::vector<std::size_t> ConvergedForce::order() const {
  std::vector<std::size_t> result(indenting_.count());
  std::iota(result.begin(), result.end(), 0);
  const auto turn = result.begin() + static_cast<std::ptrdiff_t>(indenting_.depths.size());
  std::stable_sort(result.begin(), turn, [&](auto a, auto b) { return indenting_.depths[a] < indenting_.depths[b]; });
  return result;
}

template <int Dim>
ConvergedForce::Level ConvergedForce::solveLevel(double number) const {
  const Clock::time_point start = Clock::now();
  Level level;
  CellProblem<Dim> problem = makeProblem<Dim>(number);
  level.report.level = number;
  level.report.nodes = problem.body().nodeCount();
  level.report.elements = problem.body().elementCount();
  level.report.unknowns = problem.unknowns();
  const std::size_t count = indenting_.count();
  level.forces.resize(count);
  level.wall_times.assign(count, 0);
  level.report.forces.assign(count, kNan);
  Clock::time_point mark = start;
  const bool straight = indenting_.lateral.isZero(0);  // all depths are on one line
  std::optional<IndentationSolution> last;
  for (std::size_t i : order()) {
    const Eigen::Vector3d target(indenting_.lateral.x(), indenting_.lateral.y(), -indenting_.depth(i));
    if (!straight) problem.reset();
    const double distance = (target - problem.tipDisplacement()).norm();
    IndentationSolution solution;
    if (straight && last && distance == 0) {
      solution = *last;  // the same depth again
    } else {
      solution = problem.solve(target, distance > 0 && indenting_.speed ? distance / *indenting_.speed : kInfinite);
      if (solution.converged && indenting_.hold > 0) solution = problem.solve(target, indenting_.hold);
    }
    last = solution;
    if (solution.converged && solution.force.isZero(0) && !resolves(target)) {
      solution.converged = false;
      solution.reason = "the contact is smaller than the mesh's elements";
    }
    level.wall_times[i] = secondsSince(mark);
    mark = Clock::now();
    level.reached = std::max(level.reached, -solution.tip_displacement.z());
    if (!solution.converged) {
      level.reason = solution.reason;
      if (straight) break;
      continue;
    }
    level.forces[i] = solution.force;
    level.report.forces[i] = solution.force.norm();
  }
  level.report.wall_time = secondsSince(start);
  return level;
}

/// Whether a zero force is plausible: the disc's depth is 0, or a rounded tip is beside the
/// undeformed cell.
bool ConvergedForce::resolves(const Eigen::Vector3d& displacement) const {
  const Scene::Needle& needle = scene_.needle;
  if (!needle.tip.rounded()) return true;
  const RoundedTip tip = RoundedTip::make(needle.tip.shape, needle.tip.radius, needle.tip.edge_radius);
  Eigen::Vector3d at = displacement;
  at.head<2>() += needle.offset;
  at.z() += tip.touchHeight(scene_.radius(), needle.offset);
  const double overlap = scene_.radius() - tip.distance(-at);
  return overlap <= 1e-9 * scene_.radius();
}

bool ConvergedForce::done(const ForcePoint& point) const {
  const double last = refinementOf(axisymmetric_, scene_.needle.tip).last;
  return point.converged && point.error_estimate <= config_.tolerance && point.level >= last;
}

/// Updates the points with the results of a level.
void ConvergedForce::adopt(const Level& level, Before& before, std::vector<ForcePoint>& points) const {
  const Refinement refinement = refinementOf(axisymmetric_, scene_.needle.tip);
  double largest = 0;
  for (const auto& force : level.forces) largest = force ? std::max(largest, force->norm()) : largest;
  const bool use_last_change = refinement.last > refinement.first + refinement.step;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ForcePoint& point = points[i];
    const std::optional<Eigen::Vector3d> coarser = before.forces[i];
    if (level.forces[i]) before.forces[i] = level.forces[i];
    point.wall_time += level.wall_times[i];
    if (done(point)) continue;
    if (!level.forces[i]) {
      const bool lost = coarser.has_value();
      if (lost || point.reason.empty()) {
        point.reason = (lost ? "finer meshes lose the solution before: " : "") + level.reason + "; the tip reached " +
                       micrometres(level.reached);
      }
      continue;
    }
    if (!coarser) continue;
    const bool in = i < indenting_.depths.size();
    const double size = in ? level.forces[i]->norm() : largest;
    const double change = size > 0 ? (*level.forces[i] - *coarser).norm() / size : 0;
    const double largest_change = use_last_change ? std::max(change, before.changes[i]) : change;
    before.changes[i] = change;
    point.converged = true;
    point.reason.clear();
    point.force = *level.forces[i];
    point.error_estimate = largest_change / (std::pow(2, refinement.step) - 1);
    point.level = level.report.level;
  }
}

/// Ends the refinement after an error; earlier results stay.
void ConvergedForce::abort(const std::string& error, std::vector<ForcePoint>& points) const {
  for (ForcePoint& point : points) {
    if (!done(point) && point.reason.empty()) point.reason = "a finer mesh failed: " + error;
  }
}

/// Whether a finer level may improve a point.
bool ConvergedForce::continuePath(const std::vector<ForcePoint>& points, const Level& level) const {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool solvable =
        level.forces[i] || level.report.level < 1;  // the coarsest meshes may fail where finer ones do not
    if (!done(points[i]) && solvable) return true;
  }
  return false;
}

std::vector<ForcePoint> ConvergedForce::solve(const std::function<void(const LevelReport&)>& report) {
  const Clock::time_point start = Clock::now();
  std::vector<ForcePoint> points(indenting_.count());
  for (std::size_t i = 0; i < points.size(); ++i) points[i].depth = indenting_.depth(i);
  Before before{Forces(points.size()), std::vector<double>(points.size(), 0)};
  const Refinement refinement = refinementOf(axisymmetric_, scene_.needle.tip);
  for (double number = refinement.first; number <= config_.finest; number += refinement.step) {
    Level level;
    try {
      level = axisymmetric_ ? solveLevel<2>(number) : solveLevel<3>(number);
    } catch (const std::exception& error) {
      // Without a time limit the forces must not depend on the machine.
      const bool machine = std::isinf(config_.time) && dynamic_cast<const std::bad_alloc*>(&error) != nullptr;
      if (number == refinement.first || machine) throw;
      abort(error.what(), points);
      break;
    }
    adopt(level, before, points);
    if (report) report(level.report);
    const double next = level.report.wall_time * refinement.cost;
    const bool out_of_time = number > refinement.first && secondsSince(start) + next > config_.time;
    if (!continuePath(points, level) || out_of_time) break;
  }
  for (ForcePoint& point : points) {
    if (!point.converged && point.reason.empty()) point.reason = "one mesh only has a solution";
  }
  return points;
}

}  // namespace microinjection
