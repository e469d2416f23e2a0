// How well `identify` finds a cell's modulus and its contact point from a record of the virtual force sensor.

#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "base/separated.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/printed_table.h"
#include "benchmark/common/puncture_trial.h"
#include "benchmark/common/recorded_indentation.h"
#include "cell/identification/family_law.h"
#include "cell/identification/identification.h"

namespace microinjection {
namespace {

struct Options {
  int trials = 200, seed = 100001;
  std::string kinds = "homogeneous,zona,outliers,dropouts,freeze,wrong_model";
  double deep = 5;        // um
  double strength = 0.1;  // standard deviation of the logarithm of a membrane's strength
};

class IdentifyTable {
 public:
  explicit IdentifyTable(const Options& options) : options_(options), deep_(1e-6 * options.deep) {}

  std::string rows() {
    table_.add(
        "trial,kind,modulus_error,modulus_covered,contact_error_m,puncture_error,time_s,verdict,core_modulus,"
        "rival_advantage,lowest_modulus,highest_modulus,layers_known,puncture_law,puncture_depth_m,"
        "puncture_depth_error,force_in_50,force_in_90,depth_in_50,depth_in_90\n");
    for (const std::string& kind : separated(options_.kinds)) {
      const bool main = kind == "homogeneous" || kind == "zona";
      for (int trial = 0; trial < (main ? options_.trials / 2 : options_.trials / 5); ++trial) run(kind, trial);
    }
    return table_.text();
  }

 private:
  void run(const std::string& kind, int trial) {
    const int seed = options_.seed + trial;
    random_.seed(static_cast<unsigned>(seed) + 7919U * static_cast<unsigned>(kind.size()));
    const bool zona = kind == "zona" || kind == "wrong_model";
    const auto& data = zona ? zona_ : homogeneous_;
    const DrawnCell truth = drawCell(*data, zona ? 38e-6 : 28e-6, deep_, random_);
    const double contact = uniform(2e-6, 6e-6, random_);
    FaultySensor sensor(kind, 0.1 * truth.force(deep_), seed);
    const ForceCurve curve = recordIndentation(truth, contact, deep_, sensor, random_);
    const bool punctured = options_.strength >= 0 && (kind == "homogeneous" || kind == "zona");
    std::mt19937 own(static_cast<unsigned>(seed) + 104729U * static_cast<unsigned>(kind.size()));
    const PunctureScore puncture =
        punctured ? runPunctureTrial(truth, data, options_.strength, seed, own) : PunctureScore();
    const double start = threadCpuTime();
    Found found;
    try {
      found = fit(kind, truth, contact, curve);
    } catch (const ConfigError& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    const double core = zona ? truth.scene.cell.layers[1].material.young_modulus / truth.modulus : 1;
    char row[400];
    std::snprintf(row, sizeof(row), "%d,%s,%s,%s,%.3f,%s,%.3g,%s,%s\n", trial, kind.c_str(), found.values.c_str(),
                  puncture.predicted ? number(puncture.force_error).c_str() : "", threadCpuTime() - start,
                  found.verdict.c_str(), core, found.rivals.c_str(), text(puncture).c_str());
    table_.add(row);
  }

  /// Parts of a row.
  struct Found {
    std::string values = ",,", verdict = "refused", rivals = ",,,";
  };

  Found fit(const std::string& kind, const DrawnCell& truth, double contact, const ForceCurve& curve) const {
    Scene known = truth.withModulus(1);  // it is not known
    if (kind == "wrong_model") known.cell.layers.resize(1);
    const auto& family = known.cell.layers.size() > 1 ? zona_ : homogeneous_;
    IdentificationConfig config;
    config.rivals = std::make_shared<const std::vector<RivalCell>>(rivalCells({homogeneous_, zona_}, known));
    const auto law = std::make_shared<FamilyLaw>(family, known, std::vector<std::string>{});
    const Identification found = identify(identifiedCurve(curve), law, config);
    const Estimate &modulus = *found.find("young_modulus"), &place = *found.find("contact");
    Found result;
    const bool covered = modulus.low <= truth.modulus && truth.modulus <= modulus.high;
    char part[120];
    std::snprintf(part, sizeof(part), "%.5f,%d,%.3g", modulus.value / truth.modulus - 1, covered,
                  place.value - contact);
    result.values = part;
    result.verdict = found.consistent() ? "consistent" : "inconsistent";
    const RivalComparison& rivals = *found.rivals;
    std::snprintf(part, sizeof(part), "%.1f,%.3f,%.3f,%d", rivals.advantage, rivals.modulus_low / rivals.own.modulus,
                  rivals.modulus_high / rivals.own.modulus, rivals.layersAreKnown());
    result.rivals = part;
    return result;
  }

  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.5f", value);
    return text;
  }

  static std::string text(const PunctureScore& score) {
    if (!score.predicted) return score.law + ",,,,,,";
    char text[120];
    std::snprintf(text, sizeof(text), "%s,%.3g,%.5f,%d,%d,%d,%d", score.law.c_str(), score.depth, score.depth_error,
                  score.force_in_50, score.force_in_90, score.depth_in_50, score.depth_in_90);
    return text;
  }

  Options options_;
  double deep_;  ///< m
  std::shared_ptr<const FamilyData> homogeneous_ = loadFamilyData("homogeneous"), zona_ = loadFamilyData("zona");
  std::mt19937 random_;
  PrintedTable table_;
};

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  microinjection::Options options;
  po::options_description more;
  more.add_options()("trials", po::value(&options.trials)->default_value(options.trials),
                     "cells; half of each family, and a fifth for each kind of bad record")(
      "kinds", po::value(&options.kinds)->default_value(options.kinds), "of trials, separated by commas")(
      "seed", po::value(&options.seed)->default_value(options.seed), "of the first cell")(
      "deep", po::value(&options.deep)->default_value(options.deep), "um, of the record in contact")(
      "strength", po::value(&options.strength)->default_value(options.strength),
      "standard deviation of the logarithm of the failure limits, hidden and assumed; negative: no punctures");
  return microinjection::benchMain(
      argc, argv, "identify: error and coverage of modulus and contact point over cells drawn at random",
      [&] { return microinjection::IdentifyTable(options).rows(); }, more);
}
