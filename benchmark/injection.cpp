// Automatic injection of 200 random cells: noisy force sensor, lagging rig, virtual time. The same of cells that are
// pierced by mechanics, against a force at which they fail.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/detection_figures.h"
#include "benchmark/common/surrogate_scene.h"
#include "cell/family/family_cell.h"
#include "cell/model/solved_branch.h"
#include "trial/injection_case.h"
#include "trial/injection_rig.h"

namespace microinjection {
namespace {

constexpr char kScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_pipette.yaml";
constexpr char kToughScene[] = MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tough.yaml";
constexpr char kRig[] = MICROINJECTION_SOURCE_DIR "/urdf/rig.urdf";
constexpr double kLongest = 180;  ///< s of virtual time
constexpr double kKnownTo = 0.2;  ///< deviation of the logarithm of an expected strength, in the profiles

double known_to = 0;  ///< the same of the random cells; 0: nothing is expected

std::shared_ptr<const SurrogateData> familyMember(const Scene& scene) {
  std::string refusal;
  const auto member = findFamilyCell(MICROINJECTION_SOURCE_DIR "/config/families", scene, refusal);
  if (!member) throw std::runtime_error(refusal);
  return member->data;
}

struct Bench {
  Scene scene;
  std::shared_ptr<const SurrogateData> prepared;
  ManipulatorGeometry geometry;
  SimulatedManipulatorConfig manipulator;

  /// @param manipulator_file  config file of the micromanipulator; empty: the ideal device with a
  /// lag
  Bench(const std::string& manipulator_file, const Scene& of, std::shared_ptr<const SurrogateData> data)
      : scene(of), prepared(std::move(data)) {
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

struct Outcome {
  InjectionCase of;
  InjectionRig::Truth truth;
  InjectionResult result;
  bool punctured = false, withdrawn = false, within = false, held = false;
  bool good() const { return punctured && withdrawn && within; }
};

Outcome inject(const Bench& bench, const InjectionCase& of, const InjectionRig::Disturbance& disturbance = {},
               const std::optional<PiercedBranch>& branch = {}) {
  ScaledCell cell(bench.scene, bench.prepared, of.cell, {}, branch);
  InjectionRig::Config config;
  config.controller = injectionSettings(of);
  config.disturbance = disturbance;
  config.expected = expectedPuncture(of, known_to);
  config.sensor.seed = of.seed;
  config.manipulator = bench.manipulator;
  config.manipulator.seed = of.seed;
  config.start = startOf(of);
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
  std::fprintf(
      stderr,
      "injection: outside of guards: %ld; felt without cause: %ld; failures not felt: %ld; of a force that is not "
      "valid: %ld\n",
      count([](const Outcome& o) { return !o.within; }),
      count([](const Outcome& o) { return o.truth.false_detections > 0; }),
      count([](const Outcome& o) { return o.truth.unfelt > 0; }),
      count([](const Outcome& o) { return !o.truth.valid; }));
  const auto limits = [](const Outcome& o) { return injectionSettings(o.of).guards; };
  medianAndWorst(all, "peak force", "of the limit",
                 [&](const Outcome& o) { return o.truth.peak_force / limits(o).force_limit; });
  medianAndWorst(all, "depth", "of the limit",
                 [&](const Outcome& o) { return o.truth.max_depth / limits(o).depth_limit; });
  medianAndWorst(all, "zona fails", "diameters deep",
                 [](const Outcome& o) { return o.truth.zona_depth.value_or(0) / o.of.cell.diameter; });
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

/// What follows the failure.
void summariseFailure(const std::vector<Outcome>& all) {
  std::vector<Outcome> failed;
  for (const Outcome& o : all) {
    if (o.truth.zona_depth) failed.push_back(o);
  }
  const long missed = std::count_if(failed.begin(), failed.end(),
                                    [](const Outcome& o) { return o.result.punctures < o.truth.punctures; });
  std::fprintf(stderr, "injection: %zu of %zu cells fail; %ld of these failures are missed to the end\n", failed.size(),
               all.size(), missed);
  if (failed.empty()) return;
  medianAndWorst(failed, "way on, behind the failure", "diameters",
                 [](const Outcome& o) { return (o.truth.max_depth - *o.truth.zona_depth) / o.of.cell.diameter; });
  medianAndWorst(failed, "peak force", "of that at which it fails",
                 [](const Outcome& o) { return o.truth.peak_force / o.of.cell.puncture.layers.front().force; });
}

/// The cell of the profiles: the mouse oocyte with half of its force relaxing, zona at 1.2 uN.
InjectionCase oocyte() {
  InjectionCase of;
  of.seed = 1;
  of.cell.prony = {{0.6, 0.1}, {0.4, 1}};
  of.cell.puncture = PunctureConfig::atForce(1.2e-6);
  of.cell.puncture.shaft.stiffness = 0.3;
  of.believed_modulus = of.cell.young_modulus;
  of.gap = 5e-6;
  return of;
}

/// @param fastest  m/s; 0: the controller's own profile
/// @param known    deviation of the logarithm of the expected strength; 0: nothing is expected
void profile(const Bench& bench, double fastest, double known) {
  const InjectionCase of = oocyte();
  ScaledCell cell(bench.scene, bench.prepared, of.cell);
  InjectionRig::Config config;
  config.controller = injectionSettings(of);
  config.controller.goal.margin = 0;
  config.controller.guards.speed_limit = 1e-3;
  config.controller.guards.time_limit = 60;
  auto& motion = config.controller.motion;
  motion.stab_speed = fastest > 0 ? fastest : 500e-6;
  if (fastest > 0) motion.indent_speed = fastest;
  config.expected = expectedPuncture(of, known);
  config.manipulator = bench.manipulator;
  config.start = {0, 0, 0.5 * of.cell.diameter + of.gap};
  InjectionRig rig(config, bench.geometry, cell);
  rig.run(kLongest);
  const auto& truth = rig.truth();
  std::fprintf(stderr, "injection: %s %3.0f um/s: fails at %.2f um, rests at %.2f um, felt after %.0f ms, %s\n",
               fastest > 0 ? "constant"
               : known > 0 ? "expected, profile to"
                           : "profile to",
               1e6 * motion.stab_speed, 1e6 * truth.puncture_depth.value_or(NAN), 1e6 * truth.max_depth,
               1e3 * truth.latency, toText(rig.controller().result().outcome));
}

/// How deep a needle at constant speed, or the controller's own profile, is when the zona fails,
/// and where it stops.
void profiles(const Bench& bench) {
  std::fprintf(stderr,
               "injection: a relaxing oocyte: depth where the zona fails, and where the needle comes to rest before "
               "the margin\n");
  for (const double fastest : {2e-6, 5e-6, 20e-6, 50e-6, 100e-6, 200e-6, 500e-6, 0.0}) profile(bench, fastest, 0);
  profile(bench, 0, kKnownTo);
}

/// Each disturbance at a moment of its own in each of the cells: the needle within its guards, and
/// at the end at rest or out, and the injector off.
void disturbances(const Bench& bench, int first_seed, int cells) {
  using Kind = InjectionRig::Disturbance::Kind;
  const std::pair<Kind, const char*> kinds[] = {{Kind::kNone, "a zona that does not fail"},
                                                {Kind::kForceLost, "the force is lost"},
                                                {Kind::kNeedleLost, "the needle's place is lost"},
                                                {Kind::kRigStands, "the rig stands still for 3 s"},
                                                {Kind::kInjectorDead, "the injector is dead"}};
  for (const auto& [kind, words] : kinds) {
    std::map<std::string, int> outcomes;
    int safe = 0, within = 0;
    double furthest = 0;  // 1, peak force or depth over its limit
    for (int seed = first_seed; seed < first_seed + cells; ++seed) {
      InjectionCase of = randomInjectionCase(seed);
      if (kind == Kind::kNone) of.cell.puncture.layers[0].force *= 20;
      // Between setting out and the end of an injection, which takes 3 to 10 s.
      const Outcome outcome = inject(bench, of, {kind, 0.5 + 0.137 * (seed * 29 % 50)});
      ++outcomes[toText(outcome.result.outcome)];
      safe += outcome.held;
      within += outcome.within;
      const GuardConfig limits = injectionSettings(of).guards;
      furthest = std::max(
          {furthest, outcome.truth.peak_force / limits.force_limit, outcome.truth.max_depth / limits.depth_limit});
    }
    std::fprintf(stderr,
                 "injection: disturbance: %s: %d of %d end at rest with the injector off, %d within guards (worst %.3f "
                 "of a limit);",
                 words, safe, cells, within, furthest);
    for (const auto& [outcome, count] : outcomes) std::fprintf(stderr, " %s %d", outcome.c_str(), count);
    std::fprintf(stderr, "\n");
  }
}

std::string table(int first_seed, int cells, const std::string& manipulator_file) {
  const Scene scene = loadScene(kScene);
  const Bench bench(manipulator_file, scene, std::make_shared<const SurrogateData>(surrogateScene(scene, kScene)));
  std::string text =
      "seed,diameter_m,young_modulus_Pa,punctured,withdrawn,peak_force_N,max_depth_m,detection_latency_s,"
      "false_detections,outcome\n";
  std::cout << text;
  std::vector<Outcome> all;
  for (int seed = first_seed; seed < first_seed + cells; ++seed) {
    all.push_back(inject(bench, randomInjectionCase(seed)));
    const std::string line = row(all.back());
    std::cout << line << std::flush;
    text += line;
  }
  if (!all.empty()) summarise(all);
  disturbances(bench, first_seed, cells / 5);
  profiles(bench);
  printDetectionFigures();
  return text;
}

/// A random cell whose only membrane fails at the force of the branch's onset.
InjectionCase caseAtOnset(int seed, const Scene& scene, const PiercedBranch& branch) {
  InjectionCase of = randomInjectionCase(seed);
  PunctureConfig& puncture = of.cell.puncture;
  const double length = 0.5 * of.cell.diameter / scene.radius();
  const double scale = length * length * of.cell.young_modulus / scene.cell.material().young_modulus;
  const double friction = puncture.shaft.friction / puncture.layers.front().force;
  puncture.layers = PunctureConfig::atForce(scale * branch.onset()->force).layers;
  puncture.shaft.friction = friction * puncture.layers.front().force;
  puncture.shaft.coefficient = scene.cell.puncture.shaft.coefficient;
  return of;
}

/// Each cell twice, with the same sensor noise: it fails at a force, or is pierced by mechanics with its onset there.
std::string laws(int first_seed, int cells, const std::string& manipulator_file, const std::vector<double>& toughness) {
  const Scene shipped = loadScene(kToughScene);
  const auto member = familyMember(shipped);
  std::string text =
      "law,toughness,seed,diameter_m,young_modulus_Pa,punctured,withdrawn,peak_force_N,max_depth_m,"
      "detection_latency_s,false_detections,outcome\n";
  for (const double factor : toughness) {
    Scene scene = shipped;
    scene.cell.puncture.layers.front().toughness *= factor;
    const PiercedBranch branch = storedPiercedBranch(scene);
    if (!branch.onset()) throw std::runtime_error("no depth that is solved pierces that toughness");
    const Bench bench(manipulator_file, scene, member);
    for (const bool by_mechanics : {false, true}) {
      const std::string name = by_mechanics ? "mechanics" : "force";
      std::vector<Outcome> all;
      for (int seed = first_seed; seed < first_seed + cells; ++seed) {
        const InjectionCase of = caseAtOnset(seed, scene, branch);
        all.push_back(by_mechanics ? inject(bench, of, {}, branch) : inject(bench, of));
        char law[50];
        std::snprintf(law, sizeof law, "%s,%.4g,", name.c_str(), factor);
        text += law + row(all.back());
      }
      std::fprintf(stderr,
                   "injection: %s, toughness %.4g of the scene's: onset at %.3g uN, %.3g uN behind it, of a cell of "
                   "the scene's\n",
                   name.c_str(), factor, 1e6 * branch.onset()->force, 1e6 * branch.onset()->pierced_force);
      summarise(all);
      summariseFailure(all);
    }
  }
  std::cout << text;
  return text;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  int first_seed = 1, cells = 200;
  std::string manipulator;
  std::vector<double> toughness;
  po::options_description options;
  options.add_options()("cells", po::value(&cells)->default_value(200), "how many")(
      "first-seed", po::value(&first_seed)->default_value(1), "of the cells; settings were chosen with those from 1")(
      "known-to", po::value(&microinjection::known_to)->default_value(0),
      "the controller expects the zona's force with this standard deviation of its logarithm; 0: it expects nothing")(
      "manipulator", po::value(&manipulator),
      "configuration file of the micromanipulator, e.g. config/rigs/imperfect.yaml; else an ideal one with a "
      "lag")("toughness", po::value(&toughness)->multitoken(),
             "in place of all else, each cell by a force and by mechanics, with these toughnesses over that of "
             "config/cells/mouse_oocyte_tough.yaml");
  return microinjection::benchMain(
      argc, argv,
      "injection: automatic injection of random cells, scaled from the prepared "
      "config/cells/mouse_oocyte_pipette.yaml\n"
      "(which is prepared first where it is not: minutes, once)",
      [&] {
        return toughness.empty() ? microinjection::table(first_seed, cells, manipulator)
                                 : microinjection::laws(first_seed, cells, manipulator, toughness);
      },
      options);
}
