// How soon and how well the cell estimator knows a cell's modulus while a needle indents it, at the virtual force
// sensor.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/cpu_time.h"
#include "base/errors.h"
#include "benchmark/bench_main.h"
#include "benchmark/common/drawn_cell.h"
#include "benchmark/common/faulty_sensor.h"
#include "benchmark/common/kalman_estimator.h"
#include "benchmark/common/printed_table.h"
#include "cell/estimation/cell_estimator.h"
#include "cell/estimation/force_path.h"
#include "cell/family/family_cell.h"

namespace microinjection {
namespace {

constexpr double kSpeed = 20e-6, kAsked = 5e-6;  // m/s, m
constexpr double kApproach = 10e-6;              // m, of the path before contact
constexpr double kSurface = 0.2e-6;              // m rms, of the surface above where it is modelled
constexpr int kUpdate = 20;                      // readings from one update to the next

struct Options {
  int trials = 100, seed = 200001;
  std::string kinds = "homogeneous,zona,stiffer,outliers,dropouts,freeze,drift,wrong_model";
  double deep = 8;  // um
};

class EstimatorTable {
 public:
  explicit EstimatorTable(const Options& options) : options_(options), deep_(1e-6 * options.deep) {}

  std::string rows() {
    table_.add(
        "trial,kind,factor,modulus_error,modulus_covered,converged_at_m,force_error,force_error_without_height,contact_"
        "error_m,misfit,update_s,"
        "verdict,kalman_error,kalman_covered,kalman_s\n");
    std::istringstream kinds(options_.kinds);
    for (std::string kind; std::getline(kinds, kind, ',');) {
      const bool main = kind == "homogeneous" || kind == "zona";
      for (int trial = 0; trial < (main ? options_.trials : options_.trials / 4); ++trial) run(kind, trial);
    }
    return table_.text();
  }

 private:
  struct Case {
    std::string kind;
    int trial = 0;
    DrawnCell truth;
    double surface = 0;  ///< m, of the cell above where it is modelled
    double factor = 1;   ///< of the prior's modulus
  };

  void run(const std::string& kind, int trial) {
    random_.seed(static_cast<unsigned>(options_.seed + trial) + 7919U * static_cast<unsigned>(kind.size()));
    const bool zona = kind == "zona" || kind == "wrong_model";
    const auto& data = zona ? zona_ : homogeneous_;
    Case drawn{kind, trial, drawCell(*data, zona ? 38e-6 : 28e-6, deep_, random_)};
    drawn.surface = std::normal_distribution<double>(0, kSurface)(random_);
    drawn.factor = kind == "stiffer" ? 1.0 / 3 : std::exp(uniform(-1, 1, random_));
    Scene prior = drawn.truth.withModulus(drawn.factor * drawn.truth.modulus);
    if (kind == "wrong_model") prior.cell.layers.resize(1);
    std::string reason;
    const auto member = makeFamilyCell(kind == "wrong_model" ? homogeneous_ : data, prior, reason);
    if (!member) throw ConfigError("the prior has no member: " + reason);
    indent(drawn, prior, member->data);
  }

  /// N, that a member predicts for a tip on the axis at `height` (m).
  static double forceOf(const Scene& scene, const std::shared_ptr<const SurrogateData>& cell, double height) {
    SampleHistory::Sample sample;
    sample.tip = {0, 0, height};
    std::vector<ForcePath::Point> points;
    ForcePath(scene, cell).predict({sample}, 0, points);
    return points[0].force;
  }

  void indent(const Case& drawn, const Scene& prior, const std::shared_ptr<const SurrogateData>& cell) {
    const DrawnCell& truth = drawn.truth;
    FaultySensor sensor(drawn.kind, 0.1 * truth.force(deep_), options_.seed + drawn.trial);
    CellEstimator estimator(prior, cell, {},
                            std::make_shared<const std::vector<RivalCell>>(rivalCells({homogeneous_, zona_}, prior)));
    KalmanEstimator kalman(prior, cell, {});
    const double offset = uniform(-50e-9, 50e-9, random_), drift = drawn.kind == "drift" ? 100e-9 : 0;
    const auto travel = [](double time) { return kSpeed * time - kApproach; };  // m, past the contact
    std::vector<double> times;
    double converged = 0, error = 0;
    std::vector<double> kalman_times;
    double kalman_time = 0, kalman_error = 0;
    int covered = -1, kalman_covered = -1;
    bool inconsistent = false;
    const int count = static_cast<int>(FaultySensor::kRate * (kApproach + deep_) / kSpeed);
    for (int i = 0; i < count; ++i) {
      const double time = i / FaultySensor::kRate;
      const auto reading = sensor.read(
          time, [&](double at) { return truth.force(travel(at)); }, random_);
      const double height = truth.scene.radius() + drawn.surface - travel(time);
      if (reading) {
        const double force = *reading + offset + drift * time;
        estimator.add(time, {0, 0, height}, force);
        const double before = threadCpuTime();
        kalman.add(time, {0, 0, height}, force);
        kalman_time += threadCpuTime() - before;
      }
      if (i % kUpdate != 0) continue;
      const double start = threadCpuTime();
      const CellEstimate& now = estimator.update();
      times.push_back(threadCpuTime() - start);
      kalman_times.push_back(std::exchange(kalman_time, 0));
      inconsistent = inconsistent || now.verdict == EstimateVerdict::kInconsistent;
      if (now.verdict == EstimateVerdict::kConverged && converged == 0) converged = travel(time);
      if (covered < 0 && travel(time) >= kAsked) {
        error = now.modulus / truth.modulus - 1;
        covered = now.modulus_low <= truth.modulus && truth.modulus <= now.modulus_high;
        kalman_error = kalman.modulus() / truth.modulus - 1;
        kalman_covered = kalman.covers(truth.modulus, cell->median_error);
      }
    }
    std::sort(times.begin(), times.end());
    std::sort(kalman_times.begin(), kalman_times.end());
    const CellEstimate& last = estimator.estimate();
    const double deep = travel((count - 1) / FaultySensor::kRate);
    const double height = truth.scene.radius() + drawn.surface - deep;
    const double factor = last.modulus / prior.cell.material().young_modulus;
    const double force_error = factor * forceOf(prior, cell, height - last.contact) / truth.force(deep) - 1;
    const double error_without_height = factor * forceOf(prior, cell, height) / truth.force(deep) - 1;
    char row[240];
    std::snprintf(row, sizeof(row), "%d,%s,%.3f,%.5f,%d,%.3g,%.5f,%.5f,%.3g,%.5f,%.5f,%s,%.5f,%d,%.6f\n", drawn.trial,
                  drawn.kind.c_str(), drawn.factor, error, covered, converged, force_error, error_without_height,
                  last.contact - drawn.surface, last.misfit, times[times.size() * 99 / 100],
                  inconsistent ? "inconsistent" : toText(last.verdict), kalman_error, kalman_covered,
                  kalman_times[kalman_times.size() * 99 / 100]);
    table_.add(row);
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
                     "cells of each family, and a quarter for each kind of bad record")(
      "kinds", po::value(&options.kinds)->default_value(options.kinds), "of trials, separated by commas")(
      "seed", po::value(&options.seed)->default_value(options.seed), "of the first cell")(
      "deep", po::value(&options.deep)->default_value(options.deep), "um, of the indentation");
  return microinjection::benchMain(
      argc, argv,
      "estimator: error, coverage and time of the modulus that is found while a needle indents a cell at 20 um/s",
      [&] { return microinjection::EstimatorTable(options).rows(); }, more);
}
