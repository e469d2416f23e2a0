// Section IV.A of the paper: elements stretched against the needle's motion beforehand, and whether
// that helps.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <string>

#include "benchmark/bench_main.h"
#include "benchmark/common/forked_case.h"
#include "benchmark/common/paper_mesh.h"

namespace microinjection {
namespace {

constexpr unsigned kTimeLimit = 120;  ///< s, of one row
constexpr double kStep = 0.25e-6;     ///< m
constexpr double kDeepest = 20e-6;    ///< m

/// The depth that a mesh reaches, how flat its flattest element is there and at 1 um, and the force
/// at 1 um.
std::string row(const PaperMesh& mesh, const std::string& model) {
  Scene scene;
  scene.cell.material().model = model;
  const PaperCell cell = makePaperCell(scene, mesh);
  P1QuasiStatic solver(scene, cell);
  double reached = 0, force = std::numeric_limits<double>::quiet_NaN(), jacobian = 1, jacobian_at_1um = 1;
  for (int i = 1; i * kStep <= kDeepest; ++i) {
    const double found = solver.force(i * kStep);
    if (std::isnan(found)) break;
    reached = i * kStep;
    jacobian = solver.smallestJacobian();
    if (i == 4) {
      force = found;
      jacobian_at_1um = jacobian;
    }
  }
  char text[200];
  std::snprintf(text, sizeof(text), "%s,%.3g,%zu,%zu,%zu,%.4f,%.6g,%.4f,%.4g,%.4f\n", model.c_str(), mesh.stretch,
                cell.mesh.vertices.size(), cell.mesh.tetrahedra.size(), cell.tip.size(), worstRadiusRatio(cell.mesh),
                force, jacobian_at_1um, reached, jacobian);
  return text;
}

std::string table() {
  std::string text =
      "material,stretch,vertices,tetrahedra,tip_vertices,worst_radius_ratio,force_1um_N,"
      "smallest_jacobian_1um,depth_reached_m,smallest_jacobian_there\n";
  std::cout << text;
  for (const char* model : {"st_venant_kirchhoff", "neo_hookean"}) {
    for (const std::size_t at : {6, 9}) {
      for (const double stretch : {1.0, 1.5, 2.0, 3.0}) {
        PaperMesh mesh = paperMeshes()[at];
        mesh.stretch = stretch;
        const ForkedCase outcome = runForked([&] { return row(mesh, model); }, kTimeLimit);
        if (!outcome.failure.empty()) {
          std::cerr << model << ", stretch " << stretch << ": " << outcome.failure << '\n';
        }
        std::cout << outcome.output << std::flush;
        text += outcome.output;
      }
    }
  }
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "prestretch: elements stretched against the needle beforehand",
                                   microinjection::table);
}
