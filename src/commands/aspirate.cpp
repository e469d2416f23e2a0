// The tongue that suction draws from a cell into the holding pipette; see --help.

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "base/command_line.h"
#include "base/exit_status.h"
#include "base/standard_output.h"
#include "cell/model/converged_tongue.h"
#include "cell/model/scene.h"
#include "commands/aspirate_arguments.h"

namespace microinjection {
namespace {

constexpr int kSolved = 0, kUnsolved = 3, kInexact = 4;

void say(const TonguePoint& point, double tolerance) {
  std::fprintf(stderr, "aspirate: %.4g Pa: ", point.held.pressure);
  if (!point.converged) {
    std::fprintf(stderr, "not converged: %s\n", point.reason.c_str());
    return;
  }
  std::fprintf(stderr, "tongue %.4g um, seal %.4g um, clamped with %.4g uN, error about %.2g %%%s\n",
               1e6 * point.held.tongue_length, 1e6 * point.held.seal_radius, 1e6 * point.held.clamping_force,
               100 * point.error_estimate, point.error_estimate > tolerance ? ": above the tolerance" : "");
}

std::string csvRow(const TonguePoint& point) {
  const double known = point.converged ? 1 : NAN;
  const HeldCell& held = point.held;
  char row[240];
  std::snprintf(row, sizeof(row), "%.9g,%.9g,%.9g,%.9g,%.9g,%d,%.3g\n", held.pressure, known * held.tongue_length,
                known * held.tongue_volume, known * held.seal_radius, known * held.clamping_force,
                point.converged ? 1 : 0, point.error_estimate);
  return row;
}

int run(int argc, char** argv) {
  const std::optional<AspirateArguments> arguments = parseAspirateArguments(argc, argv);
  if (!arguments) return kSolved;  // the help
  const Scene scene = loadScene(arguments->scene);
  std::vector<double> pressures = arguments->pressures;
  if (pressures.empty() && scene.holding_pipette.mouth) pressures = {scene.holding_pipette.mouth->pressure};
  const auto report = [&](double level, std::size_t solved) {
    std::fprintf(stderr, "aspirate: mesh %g: %zu of %zu pressures\n", level, solved, pressures.size());
  };
  std::string table =
      "pressure_Pa,tongue_length_m,tongue_volume_m3,seal_radius_m,clamping_force_N,converged,error_estimate\n";
  int status = kSolved;
  for (const TonguePoint& point : convergedTongues(scene, pressures, arguments->config, report)) {
    say(point, arguments->config.tolerance);
    table += csvRow(point);
    if (!point.converged) {
      status = kUnsolved;
    } else if (arguments->tolerance_given && point.error_estimate > arguments->config.tolerance && status == kSolved) {
      status = kInexact;
    }
  }
  writeTable(arguments->csv, table);
  return status;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runProgram("aspirate", [&] { return microinjection::run(argc, argv); });
}
