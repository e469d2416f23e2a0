// Forces of a cell under a round tip on finer and finer meshes: beside the axis in space, on it in the section, too.

#include <cmath>
#include <cstdio>
#include <string>

#include "benchmark/bench_main.h"
#include "cell/family/family.h"
#include "cell/mechanics/symmetric_solver.h"
#include "cell/model/cell_problem.h"
#include "cell/model/contact_frame.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

struct Place {
  double angle;            ///< rad, of the contact point
  Eigen::Vector3d target;  ///< of the tip, over R
};

template <int Dim>
std::string row(const Place& place, double level, CellProblem<Dim>&& problem) {
  const IndentationSolution solution = problem.solve(place.target);
  char line[200];
  std::snprintf(line, sizeof(line), "%s,%.0f,%.3f,%.3f,%.1f,%d,%.6f,%.1f\n", Dim == 2 ? "section" : "space",
                place.angle * 180 / M_PI, -place.target.z(), place.target.x(), level, problem.unknowns(),
                solution.converged ? solution.force.norm() : std::nan(""), solution.cpu_time);
  std::fputs(line, stdout);
  std::fflush(stdout);
  return line;
}

std::string table() {
  SymmetricSolver::useOneThread();
  const Family family = Family::load(MICROINJECTION_SOURCE_DIR "/config/families/homogeneous.yaml");
  Scene scene = family.member(Eigen::VectorXd::Zero(family.dimension()));
  std::string rows = "mesh,angle_deg,depth,lateral,level,unknowns,force,time_s\n";
  std::fputs(rows.c_str(), stdout);
  const Place places[] = {{0, {0, 0, -0.18}}, {0.4, {-0.05, 0, -0.12}}, {0.4, {-0.09, 0, -0.45}}};
  for (const Place& place : places) {
    scene.needle.offset.setZero();
    for (double level = -1; place.angle == 0 && level <= 3; ++level) {
      rows += row(place, level, CellProblem<2>(scene, makeSceneMesh<2>(scene, level), ElementKind::kP2P0));
    }
    scene.needle.offset = ContactFrame::offsetFor(scene, place.angle);
    for (double level = -1; level <= 1; level += 0.5) {
      rows += row(place, level,
                  CellProblem<3>(scene, makeHalfSceneMesh(scene, level), ElementKind::kP2P0, Symmetry::kMirror));
    }
  }
  return rows;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "bench_mesh_limit: forces of a cell on finer and finer meshes.",
                                   microinjection::table);
}
