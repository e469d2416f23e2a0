// At which depth and noise the force tells a layered cell from a homogeneous one.

#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/printed_table.h"
#include "benchmark/common/recorded_indentation.h"
#include "cell/identification/family_law.h"
#include "cell/identification/identification.h"

namespace microinjection {
namespace {

constexpr double kDepths[] = {5e-6, 8e-6, 11e-6, 14e-6};  // m
constexpr double kNoises[] = {1, 0.2};                    // of the sensor's 10 nN
constexpr double kKnown = 0.1e-6;                         // m, of a contact that is known by sight
constexpr double kNoise = 10e-9;                          // N

struct Options {
  int trials = 50, seed = 300001;
};

class LayersTable {
 public:
  explicit LayersTable(const Options& options) : options_(options) {}

  std::string rows() {
    table_.add(
        "trial,truth,estimated,depth_m,noise_N,contact_known_m,core_modulus,shell_thickness,modulus_error,rival_"
        "advantage,verdict,"
        "lowest_modulus,highest_modulus,layers_known\n");
    for (int trial = 0; trial < options_.trials; ++trial) {
      for (const bool layered : {true, false}) run(layered, trial);
    }
    return table_.text();
  }

 private:
  void run(bool layered, int trial) {
    random_.seed(static_cast<unsigned>(options_.seed + trial) + (layered ? 7919U : 0U));
    const DrawnCell truth = drawCell(layered ? *zona_ : *homogeneous_, layered ? 38e-6 : 28e-6, kDepths[3], random_);
    for (const double depth : kDepths) {
      for (const double noise : kNoises) {
        FaultySensor sensor("none", 0, options_.seed + trial, noise);
        contact_ = uniform(2e-6, 6e-6, random_);
        const ForceCurve curve = recordIndentation(truth, contact_, depth, sensor, random_);
        for (const double known : {0.0, kKnown}) {
          fit({trial, depth, noise, known, false}, truth, curve);
          if (layered) fit({trial, depth, noise, known, true}, truth, curve);
        }
      }
    }
  }

  struct Case {
    int trial = 0;
    double depth = 0, noise = 0;  ///< m; over the sensor's
    double known = 0;             ///< m, standard deviation of the contact that is known; 0: it is not
    bool layers = false;          ///< whether the assumed cell has the layers of the truth; else it is homogeneous
  };

  void fit(const Case& at, const DrawnCell& truth, const ForceCurve& curve) {
    const bool layers = at.layers;
    Scene known = truth.withModulus(1);
    const bool layered = known.cell.layers.size() > 1;
    const double core = layered ? known.cell.layers[1].material.young_modulus : 1;
    const double thickness = layered ? 1 - known.cell.layers[1].outer_radius / known.radius() : 0;
    if (!layers) known.cell.layers.resize(1);
    IdentificationConfig config;
    config.intervals = false;
    config.rivals = std::make_shared<const std::vector<RivalCell>>(rivalCells({homogeneous_, zona_}, known));
    const char *name = layered ? "layered" : "homogeneous", *estimated = layers ? "layered" : "homogeneous";
    if (at.known > 0) {
      config.contact = contact_ + at.known * std::normal_distribution<double>()(random_);
      config.contact_deviation = at.known;
    }
    char head[120], row[160];
    std::snprintf(head, sizeof(head), "%d,%s,%s,%.3g,%.3g,%.3g,%.3g,%.3g,", at.trial, name, estimated, at.depth,
                  at.noise * kNoise, at.known, core, thickness);
    try {
      const auto law = std::make_shared<FamilyLaw>(layers ? zona_ : homogeneous_, known, std::vector<std::string>{});
      const Identification found = identify(identifiedCurve(curve), law, config);
      const RivalComparison& rivals = *found.rivals;
      std::snprintf(row, sizeof(row), "%.4f,%.1f,%s,%.3f,%.3f,%d\n",
                    found.find("young_modulus")->value / truth.modulus - 1, rivals.advantage,
                    found.consistent() ? "consistent" : "inconsistent", rivals.modulus_low / rivals.own.modulus,
                    rivals.modulus_high / rivals.own.modulus, rivals.layersAreKnown());
    } catch (const ConfigError&) {
      std::snprintf(row, sizeof(row), ",,refused,,,\n");
    }
    table_.add(std::string(head) + row);
  }

  Options options_;
  std::shared_ptr<const FamilyData> homogeneous_ = loadFamilyData("homogeneous"), zona_ = loadFamilyData("zona");
  std::mt19937 random_;
  double contact_ = 0;  ///< m, of the newest record
  PrintedTable table_;
};

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  microinjection::Options options;
  po::options_description more;
  more.add_options()("trials", po::value(&options.trials)->default_value(options.trials), "cells of each family")(
      "seed", po::value(&options.seed)->default_value(options.seed), "of the first cell");
  return microinjection::benchMain(
      argc, argv, "layers: how deep a record must be to tell a layered cell from a homogeneous one",
      [&] { return microinjection::LayersTable(options).rows(); }, more);
}
