// Automatic injection of 200 random cells, with a noisy force sensor and a lagging rig, in virtual time.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "bench/bench_main.h"
#include "bench/common/detection_figures.h"
#include "bench/common/injection_rig.h"
#include "bench/common/prepared_scene.h"

namespace microinjection {
namespace {

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";
constexpr char kRig[] = MICROINJECTION_SOURCE_DIR "/urdf/rig.urdf";
constexpr double kLongest = 180;  ///< s of virtual time

struct Bench {
  Scene scene = loadScene(kScene);
  std::shared_ptr<const PreparedCell> prepared = std::make_shared<const PreparedCell>(preparedScene(scene, kScene));
  ManipulatorGeometry geometry;
  SimulatedManipulatorConfig manipulator;

  /// @param manipulator_file  config file of the micromanipulator; empty: the ideal device with a lag
  explicit Bench(const std::string& manipulator_file) {
    std::ifstream file(kRig);
    std::ostringstream text;
    text << file.rdbuf();
    geometry = ManipulatorGeometry::fromUrdf(text.str());
    if (manipulator_file.empty()) return;
    ConfigReader reader(loadYamlMap(manipulator_file), manipulator_file);
    manipulator = SimulatedManipulatorConfig::read(reader);
    reader.finish();
  }
};

/// What a random cell is, and what the operator believes of it.
struct Case {
  int seed = 0;
  ScaledCell::Properties cell;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, of the needle's line from the cell's axis
  double gap = 0;                                    ///< m, of the tip above the cell at the start
  double believed_modulus = 0;                       ///< Pa
};

/// Diameter 20 to 150 um, even; modulus 2 to 45 kPa, even in its logarithm, known to a third; zona failing at 0.03 to
/// 0.13 E R^2 (0.09 to 0.31 diameters deep), in every second cell an oolemma behind it; two Prony terms; offset up to
/// 0.3 R; what a failure leaves falls in 1 to 10 ms, to a friction of the shaft of up to 0.3 of the zona's strength.
Case randomCase(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  const auto even = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const auto evenLog = [&](double low, double high) { return low * std::pow(high / low, even(0, 1)); };
  Case result;
  result.seed = seed;
  result.cell.diameter = even(20e-6, 150e-6);
  result.cell.young_modulus = evenLog(2e3, 45e3);
  result.believed_modulus = result.cell.young_modulus * evenLog(0.75, 1.33);
  const double radius = 0.5 * result.cell.diameter, scale = result.cell.young_modulus * radius * radius;
  result.cell.prony = {{even(0.1, 0.6), evenLog(0.1, 0.5)}, {even(0.1, 0.4), evenLog(0.5, 3)}};
  const double strength = scale * evenLog(0.03, 0.13);
  result.cell.puncture = PunctureConfig::atForce(strength);
  if (seed % 2 == 0) {
    PunctureConfig::Layer oolemma;
    oolemma.name = "oolemma";
    oolemma.force = even(0.3, 0.8) * strength;
    oolemma.stiffness = oolemma.force / (even(0.03, 0.08) * result.cell.diameter);
    oolemma.gap = even(0.005, 0.02) * result.cell.diameter;
    result.cell.puncture.layers.push_back(oolemma);
  }
  result.cell.puncture.relaxation_time = evenLog(1e-3, 10e-3);
  result.cell.puncture.shaft.friction = even(0, 0.3) * strength;
  result.cell.puncture.shaft.stiffness = scale / radius;
  const double angle = even(0, 2 * M_PI), far = 0.3 * radius * std::sqrt(even(0, 1));
  result.offset = far * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  result.gap = even(5e-6, 20e-6);
  return result;
}

/// What an operator sets for a kind of cell: its diameter is seen, its modulus is believed, the layers are known.
InjectionControllerConfig settings(const Case& of) {
  const double diameter = of.cell.diameter, radius = 0.5 * diameter, scale = of.believed_modulus * radius * radius;
  InjectionControllerConfig config;
  config.mode = "automatic";
  config.guards.force_limit = std::max(0.3 * scale, 100e-9);  // ten times the noise
  config.guards.depth_limit = 0.5 * diameter;
  config.detection.contact_force = std::clamp(0.003 * scale, 8e-9, 50e-9);
  config.motion.approach_speed = std::min(20e-6, 0.25 * diameter);
  config.motion.travel_limit = of.gap + 0.35 * diameter;
  config.motion.indent_speed = 0.05 * diameter;
  config.motion.stab_speed = std::min(200e-6, 4 * diameter);
  config.motion.overshoot = 0.04 * diameter;
  config.goal.layers = static_cast<int>(of.cell.puncture.layers.size());
  config.goal.depth = 0.42 * diameter;
  config.goal.margin = 0.03 * diameter;
  return config;
}

struct Outcome {
  Case of;
  InjectionRig::Truth truth;
  InjectionResult result;
  bool punctured = false, withdrawn = false, within = false, held = false;
  bool good() const { return punctured && withdrawn && within; }
};

Outcome inject(const Bench& bench, const Case& of) {
  ScaledCell cell(bench.scene, bench.prepared, of.cell);
  InjectionRig::Config config;
  config.controller = settings(of);
  config.sensor.seed = of.seed;
  config.manipulator = bench.manipulator;
  config.manipulator.seed = of.seed;
  const double radius = 0.5 * of.cell.diameter;
  const double top = std::sqrt(radius * radius - of.offset.squaredNorm());
  config.start = {of.offset.x(), of.offset.y(), top + of.gap};
  InjectionRig rig(config, bench.geometry, cell);
  rig.run(kLongest);
  Outcome outcome{of, {}, rig.controller().result()};
  outcome.held = rig.holds();
  outcome.truth = rig.truth();
  outcome.punctured = outcome.truth.punctures == config.controller.goal.layers;
  outcome.withdrawn = outcome.truth.depth < -1e-6 && outcome.result.outcome == InjectionOutcome::kInjected;
  outcome.within = outcome.truth.peak_force <= config.controller.guards.force_limit &&
                   outcome.truth.max_depth <= config.controller.guards.depth_limit;
  return outcome;
}

std::string row(const Outcome& outcome) {
  char text[200];
  std::snprintf(text, sizeof text, "%d,%.4g,%.4g,%d,%d,%.4g,%.4g,%.3g,%d,%s\n", outcome.of.seed,
                outcome.of.cell.diameter, outcome.of.cell.young_modulus, outcome.punctured, outcome.withdrawn,
                outcome.truth.peak_force, outcome.truth.max_depth, outcome.truth.latency,
                outcome.truth.false_detections, toText(outcome.result.outcome));
  return text;
}

template <typename Value>
void medianAndWorst(const std::vector<Outcome>& all, const char* what, const char* unit, const Value& value) {
  std::vector<double> values;
  for (const Outcome& outcome : all) values.push_back(value(outcome));
  std::sort(values.begin(), values.end());
  std::fprintf(stderr, "injection: %s: median %.3g, nine of ten %.3g, worst %.3g %s\n", what, values[values.size() / 2],
               values[values.size() * 9 / 10], values.back(), unit);
}

void summarise(const std::vector<Outcome>& all) {
  const auto count = [&](const auto& is) { return std::count_if(all.begin(), all.end(), is); };
  const long good = count([](const Outcome& o) { return o.good(); });
  const long failed = count([](const Outcome& o) { return !o.good(); });
  const long held = count([](const Outcome& o) { return !o.good() && o.held; });
  std::fprintf(stderr,
               "injection: %ld of %zu cells (%.1f %%) punctured and withdrawn with peak force and depth within guards; "
               "of %ld others %ld end with the needle at rest and the injector off\n",
               good, all.size(), 100.0 * static_cast<double>(good) / static_cast<double>(all.size()), failed, held);
  std::fprintf(stderr,
               "injection: outside of guards: %ld; felt without cause: %ld; of a force that is not trusted: %ld\n",
               count([](const Outcome& o) { return !o.within; }),
               count([](const Outcome& o) { return o.truth.false_detections > 0; }),
               count([](const Outcome& o) { return !o.truth.trusted; }));
  const auto limits = [](const Outcome& o) { return settings(o.of).guards; };
  medianAndWorst(all, "peak force", "of the limit",
                 [&](const Outcome& o) { return o.truth.peak_force / limits(o).force_limit; });
  medianAndWorst(all, "depth", "of the limit",
                 [&](const Outcome& o) { return o.truth.max_depth / limits(o).depth_limit; });
  medianAndWorst(all, "puncture felt after", "ms", [](const Outcome& o) { return 1e3 * o.truth.latency; });
  medianAndWorst(all, "duration", "s", [](const Outcome& o) { return o.result.duration; });
  for (const Outcome& o : all) {
    if (o.good()) continue;
    std::fprintf(stderr, "injection: seed %d: E R^2 %.3g N, zona at %.3g N, %zu layers, %d punctured, %d felt: %s %s\n",
                 o.of.seed, 0.25 * o.of.cell.young_modulus * o.of.cell.diameter * o.of.cell.diameter,
                 o.of.cell.puncture.layers.front().force, o.of.cell.puncture.layers.size(), o.truth.punctures,
                 o.result.punctures, toText(o.result.outcome), o.result.reason.c_str());
  }
}

/// The cell of the profiles: the mouse oocyte with half of its force relaxing, zona at 1.2 uN.
Case oocyte() {
  Case of;
  of.seed = 1;
  of.cell.prony = {{0.6, 0.1}, {0.4, 1}};
  of.cell.puncture = PunctureConfig::atForce(1.2e-6);
  of.cell.puncture.shaft.stiffness = 0.3;
  of.believed_modulus = of.cell.young_modulus;
  of.gap = 5e-6;
  return of;
}

/// How deep a needle at constant speed, or the controller's own profile, is when the zona fails, and where it stops.
void profiles(const Bench& bench) {
  std::fprintf(stderr,
               "injection: a relaxing oocyte: depth where the zona fails, and where the needle comes to rest before "
               "the margin\n");
  const Case of = oocyte();
  for (const double fastest : {2e-6, 5e-6, 20e-6, 50e-6, 100e-6, 200e-6, 500e-6, 0.0}) {
    ScaledCell cell(bench.scene, bench.prepared, of.cell);
    InjectionRig::Config config;
    config.controller = settings(of);
    config.controller.goal.margin = 0;
    config.controller.guards.speed_limit = 1e-3;
    config.controller.guards.time_limit = 60;
    auto& motion = config.controller.motion;
    if (fastest > 0) {
      motion.indent_speed = motion.stab_speed = fastest;
    } else {
      motion.stab_speed = 500e-6;
    }
    config.manipulator = bench.manipulator;
    config.start = {0, 0, 0.5 * of.cell.diameter + of.gap};
    InjectionRig rig(config, bench.geometry, cell);
    rig.run(kLongest);
    const auto& truth = rig.truth();
    std::fprintf(stderr, "injection: %s %3.0f um/s: fails at %.2f um, rests at %.2f um, felt after %.0f ms, %s\n",
                 fastest > 0 ? "constant" : "profile to", 1e6 * motion.stab_speed,
                 1e6 * truth.puncture_depth.value_or(NAN), 1e6 * truth.max_depth, 1e3 * truth.latency,
                 toText(rig.controller().result().outcome));
  }
}

std::string table(int cells, const std::string& manipulator_file) {
  const Bench bench(manipulator_file);
  std::string text =
      "seed,diameter_m,young_modulus_Pa,punctured,withdrawn,peak_force_N,max_depth_m,detection_latency_s,"
      "false_detections,outcome\n";
  std::cout << text;
  std::vector<Outcome> all;
  for (int seed = 1; seed <= cells; ++seed) {
    all.push_back(inject(bench, randomCase(seed)));
    const std::string line = row(all.back());
    std::cout << line << std::flush;
    text += line;
  }
  if (!all.empty()) summarise(all);
  profiles(bench);
  printDetectionFigures();
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  int cells = 200;
  std::string manipulator;
  po::options_description options;
  options.add_options()("cells", po::value(&cells)->default_value(200), "how many")(
      "manipulator", po::value(&manipulator),
      "configuration file of the micromanipulator, e.g. src/rigs/sim/imperfect.yaml; else an ideal one with a "
      "lag");
  return microinjection::benchMain(
      argc, argv,
      "injection: automatic injection of random cells, scaled from the prepared "
      "config/cells/mouse_oocyte_pipette.yaml\n"
      "(which is prepared first where it is not: minutes, once)",
      [&] { return microinjection::table(cells, manipulator); }, options);
}
