// How far a contact with friction or adhesion is solved, the force it has, and what the way in and out loses: the mouse
// oocyte under a hemisphere.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
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

namespace microinjection {
namespace {

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";
constexpr double kQuarter = 14e-6;  ///< m, of the diameter
constexpr double kStep = 0.5e-6, kDeepest = 40e-6;
constexpr double kOut = -1e-6, kFine = 0.02e-6;  ///< beyond first contact, where adhesion's pull has a sharp peak

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
  const auto follow = [&](double from, double to, double& work, double step = kStep) {
    const int steps = static_cast<int>(std::lround(std::abs(to - from) / step));
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
  double pulled = 0;
  if (!follow(kQuarter, 0, way.back) || !follow(0, kOut, pulled, kFine)) way.back = NAN;
  way.back += pulled;
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

/// Errors of one kind of way.
class Errors {
 public:
  explicit Errors(const char* what) : what_(what) {}
  void add(double error) { all_.push_back(std::abs(error)); }
  void tell(PrintedTable& table) {
    std::sort(all_.begin(), all_.end());
    const auto at = [&](double share) {
      return 100 * all_[static_cast<std::size_t>(share * static_cast<double>(all_.size() - 1))];
    };
    char row[200];
    std::snprintf(row, sizeof row, "%s,%zu,%.2g,%.2g,%.2g\n", what_, all_.size(), at(0.5), at(0.9), at(1));
    if (!all_.empty()) table.add(row);
  }

 private:
  const char* what_;
  std::vector<double> all_;
};

/// A cell served and solved, along the same way.
class Pair {
 public:
  Pair(const Scene& scene, const std::string& families)
      : problem_(scene, makeSceneMesh<2>(scene, 1), ElementKind::kP2P0),
        served_(makeCellModel(scene, "surrogate", {families, {}, {}, {}}, "").cell) {}

  void begin() {
    problem_.reset();
    served_->release();
  }
  /// Forces along the axis, served and solved; nothing where there is no solution.
  std::optional<std::array<double, 2>> at(double depth) {
    const IndentationSolution solved = problem_.solve({0, 0, -depth});
    const TipForce force = serve(depth);
    if (!solved.converged || !force.valid) return std::nullopt;
    return std::array{force.force.z(), solved.force.z()};
  }
  double stepTime() {
    constexpr int kTimed = 10000;
    const double begin = threadCpuTime();
    for (int k = 0; k < kTimed; ++k) serve(0.5 - 0.48 * k / kTimed);
    return (threadCpuTime() - begin) / kTimed;
  }

 private:
  TipForce serve(double depth) { return served_->step({0, 0, 1 - depth}, Eigen::Vector3d::UnitZ(), time_ += 1e-3); }

  CellProblem<2> problem_;
  std::unique_ptr<CellModel> served_;
  double time_ = 0;
};

/// Cells of the shipped families that nobody has solved, served, against their own solutions: to a quarter of the
/// diameter and less, out, and in again from half of the way.
void family(PrintedTable& table, int members) {
  constexpr int kSteps = 24;
  const std::string families = MICROINJECTION_SOURCE_DIR "/config/families";
  const SectionFamily shipped = SectionFamily::load(families + "/withdrawal/homogeneous.yaml");
  std::mt19937 random(1);
  Errors in("in"), lost("lost on the way out, over the force at the turn"), out("out, over the force at the turn"),
      out_there("out, over the force there, a tenth of the turn's or more"), pull("largest pull"),
      again("in again, over the force at the turn");
  std::vector<double> times;
  for (int i = 0; i < members; ++i) {
    Eigen::VectorXd at(shipped.dimension());
    for (double& x : at) x = 2 * (random() / 4294967296.0) - 1;
    const Scene scene = shipped.member(at);
    Pair pair(scene, families);
    for (const double turn : {0.12, 0.28, 0.5}) {
      pair.begin();
      std::vector<std::array<double, 2>> on;
      for (int k = 0; k <= kSteps; ++k) {
        const auto forces = pair.at(turn * k / kSteps);
        if (!forces) break;
        on.push_back(*forces);
        if (turn * k / kSteps > 0.05) in.add((*forces)[0] / (*forces)[1] - 1);
      }
      if (on.size() <= kSteps) continue;
      const auto way = [&](int from, int to, const auto& use) {
        for (int k = from; k != to; k += from < to ? 1 : -1) {
          const auto forces = pair.at(turn * k / kSteps);
          if (!forces) return false;
          use(k, *forces);
        }
        return true;
      };
      const double unit = on.back()[1];
      const auto again_at = [&](int, const auto& force) { again.add((force[0] - force[1]) / unit); };
      const auto out_at = [&](int k, const auto& force) {
        out.add((force[0] - force[1]) / unit);
        lost.add((on[k][1] - force[1]) / unit);
        if (force[1] > 0.1 * unit) out_there.add(force[0] / force[1] - 1);
      };
      if (!way(kSteps, kSteps / 2, out_at) || !way(kSteps / 2, kSteps, again_at) || !way(kSteps, -1, out_at)) continue;
      double served = 0, solved = 0;
      const double step = 0.25 * scene.needle.contact.adhesion_range;
      for (double depth = -step; depth > -0.1; depth -= step) {
        const auto forces = pair.at(depth);
        if (!forces) break;
        served = std::max(served, -(*forces)[0]);
        solved = std::max(solved, -(*forces)[1]);
        if (-(*forces)[1] < 0.5 * solved) break;
      }
      if (solved > 0.01 * unit) pull.add(served / solved - 1);
    }
    times.push_back(pair.stepTime());
  }
  table.add("way,forces,median_percent,nine_of_ten,worst\n");
  for (Errors* errors : {&in, &lost, &out, &out_there, &pull, &again}) errors->tell(table);
  std::sort(times.begin(), times.end());
  char row[100];
  std::snprintf(row, sizeof row, "%d members; %.3g us a step on the way out\n", members, 1e6 * times[times.size() / 2]);
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
