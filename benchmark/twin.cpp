// How soon and how well the online twin knows a cell's modulus while a needle indents it, at the virtual force sensor.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "cell/estimation/cell_estimator.h"
#include "cell/family/axis_force.h"
#include "cell/family/family_cell.h"
#include "cell/family/family_file.h"
#include "cell/family/family_member.h"
#include "rig/sensor/force_sensor.h"

namespace microinjection {
namespace {

constexpr char kFamilies[] = MICROINJECTION_SOURCE_DIR "/config/families/";
constexpr double kSpeed = 20e-6, kDeep = 8e-6, kAsked = 5e-6;  // m/s, m
constexpr double kSoftest = 5e3, kStiffest = 25e3;             // Pa
constexpr double kApproach = 10e-6;                            // m, of the path before contact
constexpr double kRate = 1000;                                 // Hz, of readings
constexpr int kUpdate = 20;                                    // readings from one update to the next

struct Options {
  int trials = 100, seed = 200001;
};

std::shared_ptr<const FamilyData> load(const std::string& name) {
  const std::string file = kFamilies + name + ".yaml";
  auto read = FamilyData::load(Family::load(file), familyDataFile(file));
  if (!read) throw ConfigError(read.reason);
  return std::make_shared<const FamilyData>(std::move(*read.content));
}

/// A cell that was drawn, and its converged force on the axis: of the section, solved for this cell.
struct Truth {
  Scene scene;                  ///< with its modulus
  double surface = 0;           ///< m, of the cell above where it is modelled
  double length = 0, unit = 0;  ///< m, of the range on the axis; N of the curve
  AxisCurve curve;

  double force(double depth) const { return depth > 0 ? unit * curve(std::sqrt(depth / length)) : 0; }
};

class TwinTable {
 public:
  explicit TwinTable(const Options& options) : options_(options) {}

  std::string rows() {
    add("trial,kind,factor,modulus_error,modulus_covered,converged_at_m,force_error,contact_error_m,misfit,update_s,"
        "verdict\n");
    for (const char* kind :
         {"homogeneous", "zona", "stiffer", "outliers", "dropouts", "freeze", "drift", "wrong_model"}) {
      const bool main = std::string(kind) == "homogeneous" || std::string(kind) == "zona";
      for (int trial = 0; trial < (main ? options_.trials : options_.trials / 4); ++trial) run(kind, trial);
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
      const double modulus = std::exp(uniform(std::log(kSoftest), std::log(kStiffest)));
      truth.unit = modulus * plan.scales.energy / plan.scales.length * radius * radius;
      truth.scene = scaled(member, radius, modulus);
      truth.surface = std::normal_distribution<double>(0, 0.2e-6)(random_);
      return truth;
    }
  }

  static Scene scaled(Scene scene, double radius, double modulus) {
    for (Scene::Layer& layer : scene.cell.layers) {
      layer.outer_radius *= radius;
      layer.material.young_modulus *= modulus;
    }
    scene.needle.tip.radius *= radius;
    scene.needle.tip.edge_radius *= radius;
    scene.holding_pipette.contact_radius *= radius;
    return scene;
  }

  void run(const std::string& kind, int trial) {
    random_.seed(static_cast<unsigned>(options_.seed + trial) + 7919U * static_cast<unsigned>(kind.size()));
    const bool zona = kind == "zona" || kind == "wrong_model";
    const auto& data = zona ? zona_ : homogeneous_;
    const double radius = zona ? 38e-6 : 28e-6;
    const Truth truth = draw(*data, radius);
    const double factor = kind == "stiffer" ? 1.0 / 3 : std::exp(uniform(-1, 1));
    Scene prior = truth.scene;
    if (kind == "wrong_model") prior.cell.layers.resize(1);
    for (Scene::Layer& layer : prior.cell.layers) layer.material.young_modulus *= factor;
    std::string reason;
    const auto member = makeFamilyCell(kind == "wrong_model" ? homogeneous_ : data, prior, reason);
    if (!member) throw ConfigError("the prior has no member: " + reason);
    indent(kind, trial, truth, prior, member->data, factor);
  }

  void indent(const std::string& kind, int trial, const Truth& truth, const Scene& prior,
              const std::shared_ptr<const SurrogateData>& cell, double factor) {
    ForceSensorConfig config;
    config.seed = options_.seed + trial;
    ForceSensor sensor(config);
    CellEstimator estimator(prior, cell, {});
    const double offset = uniform(-50e-9, 50e-9), drift = kind == "drift" ? 100e-9 : 0;
    const double outlier = 0.1 * truth.force(kDeep);
    std::vector<double> times;
    double frozen = 0, converged = 0, error = 0, force_error = 0;
    int hold = 0, covered = -1;
    bool inconsistent = false;
    const int count = static_cast<int>(kRate * (kApproach + kDeep) / kSpeed);
    for (int i = 0; i < count; ++i) {
      const double time = i / kRate, travel = kSpeed * time - kApproach;  // m, past the contact
      double reading = 0;
      for (int k = 1; k <= 10; ++k) {
        const double at = travel + kSpeed * (k - 10) * 1e-4;
        reading = offset + drift * time + sensor.sample({truth.force(at), 0}, 1e-4)[0];
      }
      if (kind == "outliers" && uniform(0, 1) < 0.03) reading += outlier * (uniform(0, 1) < 0.5 ? -1 : 1);
      if (kind == "dropouts" && uniform(0, 1) < 0.01) hold = 20;
      if (kind == "freeze" && hold == 0 && uniform(0, 1) < 0.002) {
        hold = 30;
        frozen = reading;
      }
      const bool held = hold > 0 && hold-- > 0;
      const double height = truth.scene.radius() + truth.surface - travel;
      if (!(held && kind == "dropouts")) estimator.add(time, {0, 0, height}, held ? frozen : reading);
      if (i % kUpdate != 0) continue;
      const double start = threadCpuTime();
      const CellEstimate& now = estimator.update();
      times.push_back(threadCpuTime() - start);
      inconsistent = inconsistent || now.verdict == EstimateVerdict::kInconsistent;
      const double modulus = truth.scene.cell.material().young_modulus;
      if (now.verdict == EstimateVerdict::kConverged && converged == 0) converged = travel;
      if (covered < 0 && travel >= kAsked) {
        error = now.modulus / modulus - 1;
        covered = now.modulus_low <= modulus && modulus <= now.modulus_high;
      }
      force_error = now.modulus / modulus - 1;
    }
    std::sort(times.begin(), times.end());
    const CellEstimate& last = estimator.estimate();
    char row[240];
    std::snprintf(row, sizeof(row), "%d,%s,%.3f,%.5f,%d,%.3g,%.5f,%.3g,%.5f,%.5f,%s\n", trial, kind.c_str(), factor,
                  error, covered, converged, force_error, last.contact - truth.surface, last.misfit,
                  times[times.size() * 99 / 100], inconsistent ? "inconsistent" : toText(last.verdict));
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
                     "cells of each family, and a quarter for each kind of bad record")(
      "seed", po::value(&options.seed)->default_value(options.seed), "of the first cell");
  return microinjection::benchMain(
      argc, argv,
      "twin: error, coverage and time of the modulus that is found while a needle indents a cell at 20 um/s",
      [&] { return microinjection::TwinTable(options).rows(); }, more);
}
