// Pushes a needle tip into a cell and writes the force at each depth; see --help.

#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/command_line.h"
#include "base/standard_output.h"
#include "cell/model/scene.h"
#include "commands/indent_arguments.h"
#include "commands/indent_models.h"

namespace microinjection {
namespace {

constexpr int kConverged = 0, kNotConverged = 3, kNotAccurate = 4;

void report(const ForcePoint& point, double tolerance) {
  if (!point.converged) {
    std::fprintf(stderr, "indent: depth %.4g um: not converged: %s\n", 1e6 * point.depth, point.reason.c_str());
    return;
  }
  std::fprintf(stderr, "indent: depth %.4g um: force (%.5g, %.5g, %.5g) uN", 1e6 * point.depth, 1e6 * point.force.x(),
               1e6 * point.force.y(), 1e6 * point.force.z());
  if (std::isfinite(point.error_estimate)) {
    const bool missed = point.error_estimate > tolerance;
    std::fprintf(stderr, ", error about %.2g %%%s", 100 * point.error_estimate, missed ? ": above the tolerance" : "");
  }
  std::fprintf(stderr, "\n");
}

std::string csvRow(const ForcePoint& point) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d force = point.converged ? point.force : Eigen::Vector3d::Constant(nan);
  char row[200];
  std::snprintf(row, sizeof(row), "%.9g,%.9g,%.9g,%.9g,%.6f,%d,%.3g\n", point.depth, force.x(), force.y(), force.z(),
                point.wall_time, point.converged ? 1 : 0, point.error_estimate);
  return row;
}

int run(int argc, char** argv) {
  const std::optional<IndentArguments> parsed = parseIndentArguments(argc, argv);
  if (!parsed) return kConverged;  // the help
  const IndentArguments& arguments = *parsed;
  const Scene scene = loadScene(arguments.scene);
  const std::vector<ForcePoint> points = solveIndentation(scene, arguments);
  std::string table = "depth_m,force_x_N,force_y_N,force_z_N,wall_s,converged,error_estimate\n";
  int status = kConverged;
  for (const ForcePoint& point : points) {
    report(point, arguments.converged.tolerance);
    table += csvRow(point);
    const bool missed = arguments.tolerance_given && std::isfinite(point.error_estimate) &&
                        point.error_estimate > arguments.converged.tolerance;
    if (!point.converged) {
      status = kNotConverged;
    } else if (missed && status == kConverged) {
      status = kNotAccurate;
    }
  }
  writeTable(arguments.csv, table);
  return status;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runProgram("indent", [&] { return microinjection::run(argc, argv); });
}
