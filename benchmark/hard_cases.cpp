// Forces of scenes at the edge of the model; each must end with a force or a reason.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/forked_case.h"
#include "cell/model/converged_force.h"

namespace microinjection {
namespace {

constexpr unsigned kTimeLimit = 120;  ///< s, of one case
constexpr double kSpatialTime = 20;   ///< s, see ConvergedForceConfig::time
constexpr double kSectionTime = 40;   ///< s

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

struct Case {
  std::string name;
  Scene scene;
  std::vector<double> depths;  ///< m
  bool spatial = false;
};

/// Text that fits into one field of the table.
std::string field(std::string text) {
  for (char& c : text) {
    if (c == ',' || c == '\n') c = ';';
    if (c == '"') c = '\'';
  }
  return text;
}

std::string row(const Case& made, const ForcePoint& point) {
  char text[200];
  const double force = point.converged ? point.force.norm() : std::numeric_limits<double>::quiet_NaN();
  std::snprintf(text, sizeof(text), ",%.4g,%.6g,%d,%.2g,", point.depth, force, point.converged, point.error_estimate);
  std::string result = made.name + (made.spatial ? ",spatial" : ",axisymmetric") + text + field(point.reason);
  std::snprintf(text, sizeof(text), ",%.1f\n", point.wall_time);
  return result + text;
}

std::string solve(const Case& made) {
  ConvergedForceConfig config;
  config.model = made.spatial ? ConvergedForceConfig::Model::kSpatial : ConvergedForceConfig::Model::kAxisymmetric;
  config.time = made.spatial ? kSpatialTime : kSectionTime;
  Indenting indenting;
  indenting.depths = made.depths;
  std::string rows;
  for (const ForcePoint& point : ConvergedForce(made.scene, indenting, config).solve()) rows += row(made, point);
  return rows;
}

/// The same without a force, for each depth.
std::string failed(const Case& made, const std::string& reason, double time) {
  ForcePoint point;
  point.reason = reason;
  point.wall_time = time;
  std::string rows;
  for (const double depth : made.depths) {
    point.depth = depth;
    rows += row(made, point);
  }
  return rows;
}

/// In a process of its own, so that a crash or a case out of time (it hangs, or is slow) becomes
/// rows, too.
std::string run(const Case& made) {
  const double start = now();
  const ForkedCase result = runForked(
      [&] {
        try {
          return solve(made);
        } catch (const std::exception& exception) {
          return failed(made, std::string("exception: ") + exception.what(), now() - start);
        }
      },
      kTimeLimit);
  if (!result.failure.empty()) return failed(made, result.failure, now() - start);
  return result.output;
}

Scene standard(const std::string& model = "neo_hookean") {
  Scene scene;
  scene.cell.material().model = model;
  return scene;
}

Scene hemisphere(double offset) {
  Scene scene;
  scene.needle.tip.shape = "hemisphere";
  scene.needle.offset.x() = offset;
  return scene;
}

/// Shell of 4 um and the inside of it.
Scene layered(double shell_modulus, double inner_modulus) {
  Scene scene;
  scene.cell.layers.resize(2);
  scene.cell.layers[0].name = "shell";
  scene.cell.layers[0].material.young_modulus = shell_modulus;
  scene.cell.layers[1].name = "inside";
  scene.cell.layers[1].outer_radius = 24e-6;
  scene.cell.layers[1].material.young_modulus = inner_modulus;
  return scene;
}

Scene sized(double diameter, double tip, double holding) {
  Scene scene;
  scene.cell.layers[0].outer_radius = diameter / 2;
  scene.needle.tip.radius = tip;
  scene.holding_pipette.contact_radius = holding;
  return scene;
}

std::vector<Case> cases() {
  std::vector<Case> result;
  Scene scene = standard();
  scene.cell.material().poisson_ratio = 0.4999;
  result.push_back({"nu_0.4999", scene, {1e-6, 5e-6}});
  result.push_back({"stiff_shell_1000", layered(17.9e3, 17.9), {1e-6, 3e-6}});
  result.push_back({"soft_shell_1000", layered(17.9, 17.9e3), {1e-6, 3e-6}});
  result.push_back({"tip_0.5um", sized(56e-6, 0.5e-6, 10e-6), {0.2e-6, 1e-6}});
  result.push_back({"tip_10um", sized(56e-6, 10e-6, 10e-6), {1e-6, 5e-6}});
  result.push_back({"cell_20um", sized(20e-6, 1e-6, 4e-6), {1e-6, 3e-6}});
  result.push_back({"cell_1.2mm", sized(1.2e-3, 10e-6, 200e-6), {5e-6, 50e-6}});
  for (const std::string model : {"linear", "neo_hookean"}) {
    for (const double offset : {0.7, 0.8, 0.84}) {  // of the radius; Scene::validate allows 0.842
      scene = standard(model);
      scene.needle.offset.x() = offset * scene.radius();
      result.push_back({"offset_" + std::to_string(offset).substr(0, 4) + "R_" + model, scene, {0.5e-6}, true});
    }
  }
  result.push_back({"too_deep_st_venant_kirchhoff", standard("st_venant_kirchhoff"), {10e-6}});
  result.push_back({"too_deep_neo_hookean", standard(), {30e-6}});
  result.push_back({"too_deep_hemisphere", hemisphere(0), {54e-6}});
  result.push_back({"jump_direct", standard(), {10e-6}});
  result.push_back({"jump_in_steps", standard(), {1e-6, 2e-6, 5e-6, 10e-6}});
  result.push_back({"hemisphere_offset_10um", hemisphere(10e-6), {1e-6, 2e-6}, true});
  return result;
}

std::string table() {
  std::string table = "case,model,depth_m,force_N,converged,error_estimate,reason,time_s\n";
  std::cout << table;
  for (const Case& made : cases()) {
    const std::string rows = run(made);
    std::cout << rows << std::flush;
    table += rows;
  }
  return table;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::benchMain(argc, argv,
                                   "hard_cases: converged forces of scenes at the edge of what the model carries",
                                   microinjection::table);
}
