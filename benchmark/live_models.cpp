// Elements for a rounded tip's cell while the needle moves: force error and time.

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/call_times.h"
#include "cell/model/cell_problem.h"
#include "cell/model/contact_frame.h"
#include "cell/model/converged_force.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr double kMove = 0.75e-6;                   ///< m, of the tip from solution to solution
const std::vector<int> kSolutions = {2, 4, 8, 12};  ///< after which the force is compared: 1.5 to 9 um deep
constexpr double kFinest = -0.5;                    ///< level of the truth in space
constexpr std::array<double, 2> kAngles = {0, 30};  ///< degrees, of the place from the pole
constexpr double kDegree = 3.14159265358979323846 / 180;

struct Candidate {
  const char* name;
  ElementKind element;
  double level;
};
const std::vector<Candidate> kCandidates = {{"p1", ElementKind::kP1, -2},      {"p1", ElementKind::kP1, -1},
                                            {"p1", ElementKind::kP1, 0},       {"mini", ElementKind::kMini, -2},
                                            {"mini", ElementKind::kMini, -1},  {"p1_p1", ElementKind::kP1P1, -2},
                                            {"p1_p1", ElementKind::kP1P1, -1}, {"p2_p0", ElementKind::kP2P0, -2.5},
                                            {"p2_p0", ElementKind::kP2P0, -2}, {"p2_p0", ElementKind::kP2P0, -1}};

Scene sceneAt(double degrees) {
  Scene scene = loadScene(std::string(MICROINJECTION_SOURCE_DIR) + "/config/cells/mouse_oocyte_pipette.yaml");
  scene.needle.offset = ContactFrame::offsetFor(scene, degrees * kDegree);
  return scene;
}

struct Run {
  int unknowns = 0;
  double make = 0;                      ///< s
  std::vector<double> times;            ///< s, of each solution
  std::vector<Eigen::Vector3d> forces;  ///< N
  std::string reason;
};

Run follow(const Scene& scene, const Candidate& candidate, int solutions) {
  Run run;
  const double start = processTime();
  CellProblem<3> problem(scene, makeSceneMesh<3>(scene, candidate.level), candidate.element);
  run.make = processTime() - start;
  run.unknowns = problem.unknowns();
  for (int i = 1; i <= solutions; ++i) {
    const double before = processTime();
    const IndentationSolution solution = problem.solve({0, 0, -kMove * i});
    if (!solution.converged) {
      run.reason = solution.reason;
      break;
    }
    run.times.push_back(processTime() - before);
    run.forces.push_back(solution.force);
  }
  return run;
}

/// N, after each of kSolutions; on the axis from the section, whose meshes are far finer.
std::vector<std::optional<Eigen::Vector3d>> truth(const Scene& scene) {
  std::vector<std::optional<Eigen::Vector3d>> result;
  if (isAxisymmetric(scene)) {
    Indenting indenting;
    for (int i : kSolutions) indenting.depths.push_back(kMove * i);
    for (const ForcePoint& point : ConvergedForce(scene, indenting, {}).solve()) {
      result.push_back(point.converged ? std::optional<Eigen::Vector3d>(point.force) : std::nullopt);
    }
    return result;
  }
  const Run run = follow(scene, {"p2_p0", ElementKind::kP2P0, kFinest}, kSolutions.back());
  for (int i : kSolutions) {
    const bool there = i <= static_cast<int>(run.forces.size());
    result.push_back(there ? std::optional<Eigen::Vector3d>(run.forces[i - 1]) : std::nullopt);
  }
  return result;
}

std::string rows(const Candidate& candidate, double angle, const Run& run,
                 const std::vector<std::optional<Eigen::Vector3d>>& truth) {
  std::string result;
  for (std::size_t k = 0; k < kSolutions.size(); ++k) {
    const std::size_t count = kSolutions[k];
    if (!truth[k] || run.forces.size() < count) continue;
    const double error = (run.forces[count - 1] - *truth[k]).norm() / truth[k]->norm();
    char text[200];
    std::snprintf(text, sizeof(text), "%s,%g,%g,%.2g,%d,%.3g,%.3g,%.3g,%.4g,%.3g\n", candidate.name, candidate.level,
                  angle, 1e6 * kMove * static_cast<double>(count), run.unknowns, 1e3 * run.make,
                  1e3 * quantile(run.times, 0.5), 1e3 * quantile(run.times, 1), 1e6 * run.forces[count - 1].norm(),
                  error);
    result += text;
  }
  if (!run.reason.empty()) std::fprintf(stderr, "%s %g: %s\n", candidate.name, candidate.level, run.reason.c_str());
  return result;
}

std::string table() {
  std::string result =
      "element,level,angle_deg,depth_um,unknowns,make_ms,solution_ms,slowest_ms,force_uN,force_error\n";
  std::fputs(result.c_str(), stdout);
  for (const double angle : kAngles) {
    const Scene scene = sceneAt(angle);
    const auto converged = truth(scene);
    for (const Candidate& candidate : kCandidates) {
      const std::string more = rows(candidate, angle, follow(scene, candidate, kSolutions.back()), converged);
      std::fputs(more.c_str(), stdout);
      std::fflush(stdout);
      result += more;
    }
  }
  return result;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv,
                                   "live_models: P1, MINI, P1-P1 and P2-P0 in space under a hemisphere, which the tip "
                                   "enters by 0.75 um a solution (times: processor, of the whole process).",
                                   microinjection::table);
}
