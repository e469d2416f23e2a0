// The served explicit dynamics: force error against the needle's speed, and time of a tick.

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/cpu_time.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/call_times.h"
#include "cell/model/converged_force.h"
#include "cell/model/explicit_cell_model.h"

namespace microinjection {
namespace {

constexpr double kTick = 1e-3;                                     ///< s
constexpr double kAbove = 0.5e-6;                                  ///< m, of the tip over the pole at the start
const std::vector<double> kSpeeds = {5e-6, 20e-6, 50e-6, 100e-6};  ///< m/s
const std::vector<double> kDepths = {1e-6, 2e-6, 5e-6, 10e-6};     ///< m

const std::vector<std::string> kCells = {"mouse_oocyte_linear", "mouse_oocyte_st_venant_kirchhoff"};

/// N at each depth, from the section, on meshes that are refined until the force no longer changes.
std::vector<double> convergedForces(const Scene& scene) {
  Indenting indenting;
  indenting.depths = kDepths;
  std::vector<double> forces;
  for (const ForcePoint& point : ConvergedForce(scene, indenting, {}).solve()) {
    forces.push_back(point.converged ? point.force.z() : std::nan(""));
  }
  return forces;
}

/// Forces while the needle passes each depth. `times`: s of CPU, of each tick.
std::vector<double> ramp(ExplicitCellModel& cell, const Scene& scene, double speed, std::vector<double>& times) {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::vector<double> forces;
  double depth = -kAbove, time = 0;
  for (const double goal : kDepths) {
    TipForce force;
    while (depth < goal) {
      depth = std::min(goal, depth + speed * kTick);
      const double start = threadCpuTime();
      force = cell.step((scene.radius() - depth) * up, up, time += kTick);
      times.push_back(threadCpuTime() - start);
    }
    forces.push_back(force.valid ? force.force.z() : std::nan(""));
  }
  return forces;
}

std::string rows(const std::string& name) {
  const Scene scene = loadScene(std::string(MICROINJECTION_SOURCE_DIR) + "/config/cells/" + name + ".yaml");
  const std::vector<double> converged = convergedForces(scene);
  std::fprintf(stderr, "%s: %s\n", name.c_str(), ExplicitCellModel(scene, {}).description().c_str());
  std::string result;
  for (const double speed : kSpeeds) {
    ExplicitCellModel cell(scene, {});
    std::vector<double> times;
    const std::vector<double> forces = ramp(cell, scene, speed, times);
    for (std::size_t i = 0; i < kDepths.size(); ++i) {
      char text[200];
      std::snprintf(text, sizeof(text), "%s,%g,%g,%.4g,%.4g,%.3g,%.3g,%.3g\n", name.c_str(), 1e6 * speed,
                    1e6 * kDepths[i], 1e6 * forces[i], 1e6 * converged[i], forces[i] / converged[i] - 1,
                    1e6 * quantile(times, 0.5), 1e6 * quantile(times, 0.99));
      std::fputs(text, stdout);
      result += text;
    }
  }
  return result;
}

std::string table() {
  std::string result = "cell,speed_um_s,depth_um,force_uN,converged_uN,error,tick_us,slowest_tick_us\n";
  std::fputs(result.c_str(), stdout);
  for (const std::string& name : kCells) result += rows(name);
  return result;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv,
                                   "explicit_model: force error of the served explicit dynamics against the needle's "
                                   "speed, and the processor time of a tick.",
                                   microinjection::table);
}
