// How far a contact with friction or adhesion is solved, the force it has, and what the way in and out loses: the mouse
// oocyte under a hemisphere.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "base/cpu_time.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/printed_table.h"
#include "cell/choice/make_cell_model.h"
#include "cell/family/section_family.h"
#include "cell/mechanics/symmetric_solver.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"
#include "cell/surrogate/surrogate_cell_model.h"

namespace microinjection {
namespace {

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";
constexpr double kQuarter = 14e-6;  ///< m, of the diameter
constexpr double kStep = 0.5e-6, kDeepest = 40e-6, kOut = -1e-6;

struct Rubbed {
  double friction;  ///< < 0: it sticks
  double adhesion;  ///< J/m^2
};

Scene sceneOf(const Rubbed& of) {
  Scene scene = loadScene(kScene);
  scene.needle.contact.mode = of.friction < 0 ? "sticking" : "sliding";
  scene.needle.contact.friction = std::max(0.0, of.friction);
  scene.needle.contact.adhesion_energy = of.adhesion;
  scene.needle.contact.adhesion_range = of.adhesion > 0 ? 0.1e-6 : 0;
  return scene;
}

struct Way {
  double deepest = 0;                ///< m, with a solution
  double quarter = NAN;              ///< N, at kQuarter
  double given = NAN, back = NAN;    ///< J, to kQuarter and out of it
  double pull = 0;                   ///< N, largest on the way out
  double penetration = 0, time = 0;  ///< m, at kQuarter; s
};

template <int Dim>
Way drive(CellProblem<Dim>& problem, double deepest) {
  Way way;
  const auto follow = [&](double from, double to, double& work) {
    const int steps = static_cast<int>(std::lround(std::abs(to - from) / kStep));
    double last = problem.solve({0, 0, -from}).force.z();
    work = 0;
    for (int i = 1; i <= steps; ++i) {
      const double depth = from + (to - from) * i / steps;
      const IndentationSolution solution = problem.solve({0, 0, -depth});
      way.time += solution.cpu_time;
      if (!solution.converged) return false;
      way.deepest = std::max(way.deepest, depth);
      way.pull = std::max(way.pull, -solution.force.z());
      work += 0.5 * (last + solution.force.z()) * std::abs(to - from) / steps;
      last = solution.force.z();
    }
    return true;
  };
  double on = 0;
  if (!follow(0, kQuarter, way.given)) return way.given = NAN, way;
  way.quarter = problem.solve({0, 0, -kQuarter}).force.z();
  if (!follow(kQuarter, kOut, way.back)) way.back = NAN;
  problem.reset();
  if (deepest > kQuarter) follow(0, deepest, on);
  return way;
}

template <int Dim>
void add(PrintedTable& table, const Rubbed& of, double level, double deepest) {
  const Scene scene = sceneOf(of);
  CellProblem<Dim> problem(scene, makeSceneMesh<Dim>(scene, level), ElementKind::kP2P0);
  const Way way = drive(problem, deepest);
  char row[200];
  std::snprintf(row, sizeof row, "%s,%s,%g,%g,%.1f,%.5g,%.3g,%.3g,%.3g\n", Dim == 2 ? "section" : "space",
                of.friction < 0 ? "sticks" : std::to_string(of.friction).substr(0, 4).c_str(), of.adhesion, level,
                1e6 * way.deepest, 1e6 * way.quarter, 100 * (1 - way.back / way.given), 1e9 * way.pull, way.time);
  table.add(row);
}

void solveAll(PrintedTable& table, const std::string& meshes) {
  SymmetricSolver::useOneThread();
  table.add("mesh,friction,adhesion_J_per_m2,level,deepest_um,force_at_14_um_uN,lost_percent,pull_nN,time_s\n");
  for (const Rubbed& of : {Rubbed{0, 0},
                           {0.01, 0},
                           {0.05, 0},
                           {0.1, 0},
                           {0.2, 0},
                           {0.5, 0},
                           {2, 0},
                           {-1, 0},
                           {0.1, 1e-4},
                           {0.1, 1e-3},
                           {0.5, 1e-3}}) {
    for (const double level : {0.0, 1.0}) {
      if (meshes.find("section") != std::string::npos) add<2>(table, of, level, kDeepest);
    }
  }
  for (const Rubbed& of : {Rubbed{0.1, 0}, {0.5, 0}, {0.1, 1e-3}}) {
    if (meshes.find("space") != std::string::npos) add<3>(table, of, -1, kQuarter);
  }
}

/// Cells of the shipped families that nobody has solved, served, against their own solutions to a quarter of the
/// diameter.
void family(PrintedTable& table, int members) {
  const std::string families = MICROINJECTION_SOURCE_DIR "/config/families";
  const SectionFamily shipped = SectionFamily::load(families + "/friction/homogeneous.yaml");
  std::mt19937 random(1);
  std::vector<double> errors, times;
  for (int i = 0; i < members; ++i) {
    Eigen::VectorXd at(shipped.dimension());
    for (double& x : at) x = 2 * (random() / 4294967296.0) - 1;
    const Scene scene = shipped.member(at);
    const ServingPlan plan = planServing(scene, "surrogate", families, "");
    SurrogateCellModel served(scene, plan.source.data);
    CellProblem<2> problem(scene, makeSceneMesh<2>(scene, 1), ElementKind::kP2P0);
    double time = 0;
    served.step({0, 0, 1 + 1e-3}, Eigen::Vector3d::UnitZ(), time += 1e-3);
    for (int i = 1; i <= 25; ++i) {
      const double depth = 0.02 * i;
      const IndentationSolution solved = problem.solve({0, 0, -depth});
      if (!solved.converged) break;
      const TipForce force = served.step({0, 0, 1 - depth}, Eigen::Vector3d::UnitZ(), time += 1e-3);
      if (force.valid && depth > 0.05) errors.push_back(std::abs(force.force.z() / solved.force.z() - 1));
    }
    constexpr int kTimed = 10000;
    const double begin = threadCpuTime();
    for (int k = 0; k < kTimed; ++k)
      served.step({0, 0, 0.5 + 0.48 * k / kTimed}, Eigen::Vector3d::UnitZ(), time += 1e-3);
    times.push_back((threadCpuTime() - begin) / kTimed);
  }
  std::sort(errors.begin(), errors.end());
  std::sort(times.begin(), times.end());
  char row[200];
  std::snprintf(row, sizeof row,
                "family of %d members: force error median %.3g %%, nine of ten %.3g %%, worst %.3g %%; %zu forces; "
                "%.3g us a step\n",
                members, 100 * errors[errors.size() / 2], 100 * errors[errors.size() * 9 / 10], 100 * errors.back(),
                errors.size(), 1e6 * times[times.size() / 2]);
  table.add(row);
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  using namespace microinjection;
  namespace po = boost::program_options;
  std::string meshes = "section,space,family";
  int members = 30;
  po::options_description more;
  more.add_options()("meshes", po::value(&meshes)->default_value(meshes),
                     "section, space; family: members at random, served");
  more.add_options()("members", po::value(&members)->default_value(members), "of the family");
  return benchMain(
      argc, argv, "friction: forces of a cell under a tip that rubs or adheres",
      [&] {
        PrintedTable rows;
        solveAll(rows, meshes);
        if (meshes.find("family") != std::string::npos) family(rows, members);
        return rows.text();
      },
      more);
}
