// Equation (13) of the paper: the stable time step at the cell's true mass, the mass that real time
// would need, and what that costs in error of the force.

#include <algorithm>
#include <cmath>
#include <cstdio>
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

constexpr unsigned kTimeLimit = 240;  ///< s, of one row, where the machine is shared
constexpr double kDeepest = 1e-6;     ///< m
constexpr int kDepths = 10;
constexpr double kSpeed = 1e-4;  ///< m/s, of the needle; ten times faster is as bad as a hundredfold mass
constexpr double kShare = 0.9;   ///< of the time step to the bound

struct Case {
  Scene scene;
  PaperCell cell;
  ExplicitStepConfig config;
  double bound;  ///< rad/s

  explicit Case(const PaperMesh& mesh) {
    scene.cell.material().model = "st_venant_kirchhoff";
    cell = makePaperCell(scene, mesh);
    const MaterialConfig& material = scene.cell.material();
    config.lame = Lame::from(material.young_modulus, material.poisson_ratio);
    config.held = cell.held;
    config.tip = cell.tip;
    bound = frequencyBound(cell.mesh, config.lame, config.density);
  }
};

/// Whether a small jump of the tip stays small for a while.
bool isStable(Case& at, double time_step) {
  at.config.time_step = time_step;
  ExplicitStep dynamics(at.cell.mesh, at.config);
  for (int i = 0; i < 4000; ++i) dynamics.step({0, 0, -1e-12});
  double largest = 0;
  for (std::size_t i = 0; i < dynamics.positions().size(); ++i) {
    const double moved = std::abs(dynamics.positions()[i] - at.cell.mesh.vertices[i / 3][static_cast<int>(i % 3)]);
    if (!(moved < 1e-10)) return false;
    largest = std::max(largest, moved);
  }
  return largest > 0;
}

/// s, to a part in a thousand.
double observedLimit(Case& at) {
  double good = 1.9 / at.bound, bad = 8 / at.bound;
  while (bad / good > 1.001) {
    const double middle = std::sqrt(good * bad);
    (isStable(at, middle) ? good : bad) = middle;
  }
  return good;
}

std::string limits(const PaperMesh& mesh) {
  Case at(mesh);
  const double observed = observedLimit(at);
  at.config.time_step.reset();
  const double exact = 2 / ExplicitStep(at.cell.mesh, at.config).highestFrequency();
  at.config.time_step = kShare * 2 / at.bound;
  ExplicitStep dynamics(at.cell.mesh, at.config);
  const double cost = 1e-6 * quantile(callTimes([&](int) { dynamics.step({0, 0, 0}); }, 10, 1000, 1, 50), 0.5);
  char text[200];
  std::snprintf(text, sizeof(text), "limit,%zu,%zu,,,,,%.6g,%.6g,%.6g,%.6g,,\n", at.cell.mesh.vertices.size(),
                at.cell.mesh.tetrahedra.size(), 2 / at.bound, exact, observed, cost);
  return text;
}

/// The force while the needle goes in at a constant speed, against the equilibria of the same mesh.
/// Damped critically for a shear wave of two diameters.
std::string ramp(const PaperMesh& mesh, double scale) {
  Case at(mesh);
  at.config.density *= scale;
  at.config.time_step = kShare * 2 / (at.bound / std::sqrt(scale));
  at.config.damping = 2 * M_PI * std::sqrt(at.config.lame.mu / at.config.density) / at.scene.cell.diameter();
  ExplicitStep dynamics(at.cell.mesh, at.config);
  P1QuasiStatic equilibria(at.scene, at.cell);
  std::string rows;
  double time = 0;
  for (int i = 1; i <= kDepths; ++i) {
    const double depth = kDeepest * i / kDepths;
    // The force is that of the positions from which the last step set out: one step more.
    double tip = 0;
    for (bool there = false; !there;) {
      there = tip >= depth;
      time += there ? 0 : dynamics.timeStep();
      tip = std::min(kSpeed * time, depth);
      dynamics.step({0, 0, -tip});
    }
    const double force = dynamics.force().z(), expected = equilibria.force(depth);
    char text[250];
    std::snprintf(text, sizeof(text), "ramp,%zu,%zu,%.6g,%.6g,%.6g,%.6g,%.6g,,,,%.6g,%.6g\n",
                  at.cell.mesh.vertices.size(), at.cell.mesh.tetrahedra.size(), scale, kSpeed, depth, time,
                  dynamics.timeStep(), force, expected);
    rows += text;
  }
  return rows;
}

std::string table() {
  std::string text =
      "kind,vertices,tetrahedra,mass_scale,speed_m_s,depth_m,time_s,stable_step_s,exact_step_s,"
      "observed_limit_s,step_cost_s,force_N,equilibrium_N\n";
  std::cout << text;
  const auto add = [&](const std::function<std::string()>& work) {
    const ForkedCase outcome = runForked(work, kTimeLimit);
    if (!outcome.failure.empty()) std::cerr << "the row after the last one: " << outcome.failure << '\n';
    std::cout << outcome.output << std::flush;
    text += outcome.output;
  };
  for (const PaperMesh& mesh : paperMeshes()) add([&] { return limits(mesh); });
  for (const std::size_t row : {std::size_t{1}, paperMeshes().size() - 1}) {
    for (const double scale : {1.0, 1e2, 1e4, 1e6, 1e8}) {
      add([&] { return ramp(paperMeshes()[row], scale); });
    }
  }
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv, "dynamics: stable time step, mass scaling and its price",
                                   microinjection::table);
}
