// How well `identify` finds a cell's modulus and its contact point from a record of the virtual force sensor.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "cell/family/axis_force.h"
#include "cell/family/family_file.h"
#include "cell/family/family_member.h"
#include "cell/identification/family_law.h"
#include "cell/identification/identification.h"
#include "rig/sensor/force_sensor.h"

namespace microinjection {
namespace {

constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families/";
constexpr double kSpeed = 20e-6, kDeep = 5e-6;      // m/s, m
constexpr double kSoftest = 5e3, kStiffest = 25e3;  // Pa
constexpr double kRate = 1000;                      // Hz, of the record

struct Options {
  int trials = 200, seed = 100001;
};

std::shared_ptr<const FamilyData> load(const std::string& name) {
  const std::string file = kFamilies + name + ".yaml";
  auto read = FamilyData::load(Family::load(file), familyDataFile(file));
  if (!read) throw ConfigError(read.reason);
  return std::make_shared<const FamilyData>(std::move(*read.content));
}

/// A cell that was drawn, and its converged force: of the section, solved for this cell.
struct Truth {
  Scene scene;  ///< without a modulus: it is 1 Pa
  double modulus = 0, contact = 0;
  double length = 0, unit = 0;  ///< m, of the range on the axis; N/Pa of the curve
  AxisCurve curve;

  double force(double depth) const { return depth > 0 ? modulus * unit * curve(std::sqrt(depth / length)) : 0; }
};

class IdentifyTable {
 public:
  explicit IdentifyTable(const Options& options) : options_(options) {}

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

  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  /// A member at random coordinates, in the size of a mouse's oocyte.
  Truth draw(const FamilyData& data, double radius) {
    const Family& family = data.family();
    for (;;) {
      Eigen::VectorXd coordinates(family.dimension());
      for (double& x : coordinates) x = uniform(-1, 1);
      const Scene member = family.member(coordinates);
      const Preparation plan = planMember(family, member);
      Truth truth;
      truth.length = plan.range.axis_depth * radius;
      if (truth.length < kDeep) continue;
      try {
        truth.curve = axisCurve(solveAxisForces(family, coordinates).array().log().matrix());
      } catch (const std::runtime_error&) {
        continue;
      }
      truth.unit = plan.scales.energy / plan.scales.length * radius * radius;
      truth.scene = scaledScene(member, radius);
      truth.modulus = std::exp(uniform(std::log(kSoftest), std::log(kStiffest)));
      truth.contact = uniform(2e-6, 6e-6);
      return truth;
    }
  }

  static Scene scaledScene(Scene scene, double radius) {
    for (Scene::Layer& layer : scene.cell.layers) layer.outer_radius *= radius;
    scene.needle.tip.radius *= radius;
    scene.needle.tip.edge_radius *= radius;
    scene.holding_pipette.contact_radius *= radius;
    return scene;
  }

  ForceCurve record(const Truth& truth, const std::string& kind, int seed) {
    ForceSensorConfig config;
    config.seed = seed;
    ForceSensor sensor(config);
    const double offset = uniform(-100e-9, 100e-9);
    ForceCurve curve;
    double frozen = 0;
    int hold = 0;
    const int count = static_cast<int>(kRate * (truth.contact + kDeep) / kSpeed);
    const double outlier = 0.1 * truth.force(kDeep);
    for (int i = 0; i < count; ++i) {
      const double time = i / kRate;
      double reading = offset;
      for (int k = 1; k <= 10; ++k) {
        const double at = time + (k - 10) * 1e-4;
        reading = offset + sensor.sample({truth.force(kSpeed * at - truth.contact), 0}, 1e-4)[0];
      }
      if (kind == "outliers" && uniform(0, 1) < 0.03) reading += outlier * (uniform(0, 1) < 0.5 ? -1 : 1);
      if (kind == "dropouts" && uniform(0, 1) < 0.01) hold = 20;
      if (kind == "freeze" && hold == 0 && uniform(0, 1) < 0.002) {
        hold = 30;
        frozen = reading;
      }
      const bool held = hold > 0 && hold-- > 0;
      if (held && kind == "dropouts") continue;
      curve.time.push_back(time);
      curve.position.push_back(kSpeed * time);
      curve.force.push_back(held ? frozen : reading);
    }
    return curve;
  }

  void run(const std::string& kind, int trial) {
    const int seed = options_.seed + trial;
    random_.seed(static_cast<unsigned>(seed) + 7919U * static_cast<unsigned>(kind.size()));
    const bool zona = kind == "zona" || kind == "wrong_model";
    const auto& data = zona ? zona_ : homogeneous_;
    const Truth truth = draw(*data, zona ? 38e-6 : 28e-6);
    const ForceCurve curve = record(truth, kind, seed);
    Scene known = truth.scene;
    if (kind == "wrong_model") known.cell.layers.resize(1);
    const double start = threadCpuTime();
    char row[200];
    try {
      const auto law =
          std::make_shared<FamilyLaw>(kind == "wrong_model" ? homogeneous_ : data, known, std::vector<std::string>{});
      const Identification found = identify(identifiedCurve(curve), law, {});
      const Estimate &modulus = *found.find("young_modulus"), &contact = *found.find("contact");
      std::snprintf(row, sizeof(row), "%d,%s,%.5f,%d,%.3g,,%.3f,%s\n", trial, kind.c_str(),
                    modulus.value / truth.modulus - 1, modulus.low <= truth.modulus && truth.modulus <= modulus.high,
                    contact.value - truth.contact, threadCpuTime() - start,
                    found.consistent() ? "consistent" : "inconsistent");
    } catch (const ConfigError& error) {
      std::snprintf(row, sizeof(row), "%d,%s,,,,,%.3f,refused\n", trial, kind.c_str(), threadCpuTime() - start);
      std::fprintf(stderr, "%s\n", error.what());
    }
    add(row);
  }

  Options options_;
  std::shared_ptr<const FamilyData> homogeneous_ = load("homogeneous"), zona_ = load("zona");
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
      "seed", po::value(&options.seed)->default_value(options.seed), "of the first cell");
  return microinjection::benchMain(
      argc, argv, "identify: error and coverage of modulus and contact point over cells drawn at random",
      [&] { return microinjection::IdentifyTable(options).rows(); }, more);
}
