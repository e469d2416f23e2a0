// Table III and figure 14 of the paper: the times of its two stages at its mesh sizes, and how far
// off its forces are.

#include <cstdio>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/call_times.h"
#include "benchmark/common/forked_case.h"
#include "benchmark/common/paper_mesh.h"
#include "cell/mechanics/explicit_step.h"
#include "cell/mechanics/largest_frequency.h"

namespace microinjection {
namespace {

constexpr unsigned kTimeLimit = 240;  ///< s, of one mesh, where the machine is shared
constexpr double kDepth = 1e-6;       ///< m, of the linear force
constexpr double kSafety = 0.8;       ///< of the time step to the bound
using Force = ExplicitStepConfig::Force;

/// The paper's mesh for validation once more, but with an edge around the tip, which that within 5
/// % of its size has no room for: it pushes a single vertex.
constexpr PaperMesh kResolved = {123, 379, 38.96e-6, 0.8, true};

struct Times {
  double off_line, off_line_least;  ///< us: all that is computed before, the mesh given
  double on_line, on_line_least;    ///< us: a time step
};

/// Off line: tensors (or what the kernel has instead), lumped masses, stable time step.
Times timesOf(const PaperCell& cell, ExplicitStepConfig config, Force force) {
  config.force = force;
  const auto prepare = [&] {
    config.time_step = kSafety * 2 / frequencyBound(cell.mesh, config.lame, config.density);
    return ExplicitStep(cell.mesh, config);
  };
  double sum = 0;
  const std::vector<double> before = callTimes([&](int) { sum += prepare().timeStep(); }, 1, 200, 1, 20);
  ExplicitStep dynamics = prepare();
  const std::vector<double> step = callTimes([&](int) { dynamics.step({0, 0, -1e-9}); }, 10, 1000, 1, 50);
  return {quantile(before, 0.5), quantile(before, 0), quantile(step, 0.5), quantile(step, 0)};
}

std::string times(const Times& t) {
  char text[120];
  std::snprintf(text, sizeof(text), ",%.6g,%.6g,%.6g,%.6g", t.off_line, t.off_line_least, t.on_line, t.on_line_least);
  return text;
}

std::string row(const PaperMesh& mesh) {
  Scene scene;
  const PaperCell cell = makePaperCell(scene, mesh);
  const MaterialConfig& material = scene.cell.material();
  ExplicitStepConfig config;
  config.lame = Lame::from(material.young_modulus, material.poisson_ratio);
  config.held = cell.held;
  config.tip = cell.tip;
  scene.cell.material().model = "linear";
  const double force = P1QuasiStatic(scene, cell).force(kDepth);
  const double bound = frequencyBound(cell.mesh, config.lame, config.density);
  char text[200];
  std::snprintf(text, sizeof(text), "%zu,%zu,%zu,%zu,%zu,%.4f,%.6g,%.6g", mesh.vertices, mesh.tetrahedra,
                cell.mesh.vertices.size(), cell.mesh.tetrahedra.size(), cell.tip.size(), worstRadiusRatio(cell.mesh),
                force, 2 / bound);
  return text + times(timesOf(cell, config, Force::kTensors)) + times(timesOf(cell, config, Force::kKernel)) + "\n";
}

std::string table() {
  std::string text =
      "paper_vertices,paper_tetrahedra,vertices,tetrahedra,tip_vertices,worst_radius_ratio,"
      "linear_force_1um_N,stable_step_s";
  for (const char* form : {"tensors", "kernel"}) {
    for (const char* stage : {"off_line", "off_line_least", "on_line", "on_line_least"}) {
      text += std::string(",") + form + "_" + stage + "_us";
    }
  }
  std::cout << (text += "\n");
  std::vector<PaperMesh> meshes = paperMeshes();
  meshes.push_back(kResolved);
  for (const PaperMesh& mesh : meshes) {
    const ForkedCase outcome = runForked([&] { return row(mesh); }, kTimeLimit);
    if (!outcome.failure.empty()) std::cerr << mesh.tetrahedra << " tetrahedra: " << outcome.failure << '\n';
    std::cout << outcome.output << std::flush;
    text += outcome.output;
  }
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "meshes: times of the paper's two stages at its mesh sizes",
                                   microinjection::table);
}
