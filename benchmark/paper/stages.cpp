// Figure 9 of the paper: the section of the cell at stages of the needle's way in.

#include <cstdio>
#include <iostream>
#include <string>

#include "benchmark/bench_main.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr double kStages[] = {0, 10e-6, 20e-6, 30e-6, 40e-6, 45e-6};  ///< m
constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";

/// Corners of each triangle of the deformed section, and how far its centre has moved.
std::string stage(const CellProblem<2>& problem, double depth, double force) {
  const QuadraticMesh<2>& mesh = problem.body().mesh();
  std::string rows;
  for (const auto& element : mesh.elements) {
    char text[300];
    Eigen::Vector2d moved = Eigen::Vector2d::Zero();
    int length = std::snprintf(text, sizeof(text), "%.6g,%.6g", depth, force);
    for (int corner = 0; corner < 3; ++corner) {
      const Eigen::Vector2d u = problem.state().segment<2>(2 * element[corner]), x = mesh.nodes[element[corner]] + u;
      moved += u / 3;
      length += std::snprintf(text + length, sizeof(text) - length, ",%.6g,%.6g", x[0], x[1]);
    }
    std::snprintf(text + length, sizeof(text) - length, ",%.6g\n", moved.norm());
    rows += text;
  }
  return rows;
}

std::string table() {
  const Scene scene = loadScene(kScene);
  CellProblem<2> problem(scene, makeSceneMesh<2>(scene, 1), ElementKind::kP2P0);
  std::string text = "depth_m,force_N,r1_m,z1_m,r2_m,z2_m,r3_m,z3_m,displacement_m\n";
  for (const double depth : kStages) {
    const IndentationSolution solution = problem.solve({0, 0, -depth});
    if (!solution.converged) {
      std::cerr << "no solution at " << 1e6 * depth << " um: " << solution.reason << '\n';
      break;
    }
    text += stage(problem, depth, solution.force.z());
  }
  std::cout << text;
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "stages: the deformed section on the needle's way in",
                                   microinjection::table);
}
