// How well `identify` finds a cell's modulus and its contact point from a record of the virtual force sensor.

#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/drawn_cell.h"
#include "benchmark/common/faulty_sensor.h"
#include "cell/identification/family_law.h"
#include "cell/identification/identification.h"

namespace microinjection {
namespace {

constexpr double kSpeed = 20e-6;  // m/s

struct Options {
  int trials = 200, seed = 100001;
  double deep = 5;  // um
};

class IdentifyTable {
 public:
  explicit IdentifyTable(const Options& options) : options_(options), deep_(1e-6 * options.deep) {}

  std::string rows() {
    add("trial,kind,modulus_error,modulus_covered,contact_error_m,puncture_error,time_s,verdict\n");
    for (const char* kind : {"homogeneous", "zona", "outliers", "dropouts", "freeze", "wrong_model"}) {
      const bool main = std::string(kind) == "homogeneous" || std::string(kind) == "zona";
      for (int trial = 0; trial < (main ? options_.trials / 2 : options_.trials / 5); ++trial) run(kind, trial);
    }
    return table_;
  }

 private:
  void add(const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    table_ += text;
  }

  /// `contact`: m, position at first contact.
  ForceCurve record(const DrawnCell& truth, double contact, const std::string& kind, int seed) {
    FaultySensor sensor(kind, 0.1 * truth.force(deep_), seed);
    const double offset = uniform(-100e-9, 100e-9, random_);
    ForceCurve curve;
    const int count = static_cast<int>(FaultySensor::kRate * (contact + deep_) / kSpeed);
    for (int i = 0; i < count; ++i) {
      const double time = i / FaultySensor::kRate;
      const auto reading = sensor.read(
          time, [&](double at) { return truth.force(kSpeed * at - contact); }, random_);
      if (!reading) continue;
      curve.time.push_back(time);
      curve.position.push_back(kSpeed * time);
      curve.force.push_back(*reading + offset);
    }
    return curve;
  }

  void run(const std::string& kind, int trial) {
    const int seed = options_.seed + trial;
    random_.seed(static_cast<unsigned>(seed) + 7919U * static_cast<unsigned>(kind.size()));
    const bool zona = kind == "zona" || kind == "wrong_model";
    const auto& data = zona ? zona_ : homogeneous_;
    const DrawnCell truth = drawCell(*data, zona ? 38e-6 : 28e-6, deep_, random_);
    const double contact = uniform(2e-6, 6e-6, random_);
    const ForceCurve curve = record(truth, contact, kind, seed);
    Scene known = truth.withModulus(1);  // it is not known
    if (kind == "wrong_model") known.cell.layers.resize(1);
    const double start = threadCpuTime();
    char row[200];
    try {
      const auto law =
          std::make_shared<FamilyLaw>(kind == "wrong_model" ? homogeneous_ : data, known, std::vector<std::string>{});
      const Identification found = identify(identifiedCurve(curve), law, {});
      const Estimate &modulus = *found.find("young_modulus"), &place = *found.find("contact");
      std::snprintf(row, sizeof(row), "%d,%s,%.5f,%d,%.3g,,%.3f,%s\n", trial, kind.c_str(),
                    modulus.value / truth.modulus - 1, modulus.low <= truth.modulus && truth.modulus <= modulus.high,
                    place.value - contact, threadCpuTime() - start, found.consistent() ? "consistent" : "inconsistent");
    } catch (const ConfigError& error) {
      std::snprintf(row, sizeof(row), "%d,%s,,,,,%.3f,refused\n", trial, kind.c_str(), threadCpuTime() - start);
      std::fprintf(stderr, "%s\n", error.what());
    }
    add(row);
  }

  Options options_;
  double deep_;  ///< m
  std::shared_ptr<const FamilyData> homogeneous_ = loadFamilyData("homogeneous"), zona_ = loadFamilyData("zona");
  std::mt19937 random_;
  std::string table_;
};

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  microinjection::Options options;
  po::options_description more;
  more.add_options()("trials", po::value(&options.trials)->default_value(options.trials),
                     "cells; half of each family, and a fifth for each kind of bad record")(
      "seed", po::value(&options.seed)->default_value(options.seed), "of the first cell")(
      "deep", po::value(&options.deep)->default_value(options.deep), "um, of the record in contact");
  return microinjection::benchMain(
      argc, argv, "identify: error and coverage of modulus and contact point over cells drawn at random",
      [&] { return microinjection::IdentifyTable(options).rows(); }, more);
}
