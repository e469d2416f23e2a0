#include "benchmark/common/detection_figures.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "hardware/sensor/force_sensor.h"
#include "operation/control/needle_monitor.h"

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;       ///< s
constexpr double kAdvance = 100e-9;  ///< m a step: 100 um/s
constexpr int kApproach = 10000;     ///< steps of a needle that sets out and feels nothing
constexpr int kRuns = 100, kTrials = 200;

/// A monitor behind a sensor that reads a force along the pipette; each run has its own offset and
/// noise.
class DetectorRun {
 public:
  DetectorRun(const DetectionConfig& config, int seed) : monitor_(config), sensor_(sensor(seed)) {
    while (!monitor_.ready()) step(0);
  }
  void step(double force) {
    const double reading = sensor_.sample({force, 0}, kStep).x();
    travel_ += kAdvance;
    monitor_.step({0, 0, -travel_}, Eigen::Vector3d::UnitZ(), {0, 0, reading});
  }
  NeedleMonitor& monitor() { return monitor_; }

 private:
  static ForceSensorConfig sensor(int seed) {
    ForceSensorConfig config;
    config.seed = seed;
    return config;
  }
  NeedleMonitor monitor_;
  ForceSensor sensor_;
  double travel_ = 0;  ///< m
};

void falseTouches(const DetectionConfig& config) {
  int alarms = 0, confirmed = 0, punctures = 0;
  for (int run = 1; run <= kRuns; ++run) {
    DetectorRun feeler(config, run);
    for (int i = 0; i < kApproach; ++i) {
      feeler.step(0);
      punctures += feeler.monitor().punctured();
      if (!feeler.monitor().confirmed()) continue;
      ++alarms;
      confirmed += *feeler.monitor().confirmed();
      feeler.monitor().rearm();
    }
  }
  std::fprintf(
      stderr,
      "injection: %d approaches of %.0f s that feel nothing, contact_force %.0f nN: %d alarms, %d of them confirmed by "
      "the second look, %d punctures\n",
      kRuns, kApproach * kStep, 1e9 * config.contact_force, alarms, confirmed, punctures);
}

/// ms, half of all and nine of ten; "missed" counts those above `longest` (steps).
template <typename Felt>
void latencies(const DetectionConfig& config, const char* what, double before, double after, const Felt& felt) {
  constexpr int kMostSteps = 1000;
  std::vector<int> steps;
  int missed = 0;
  for (int trial = 1; trial <= kTrials; ++trial) {
    DetectorRun feeler(config, trial);
    for (int i = 0; i < 600; ++i) feeler.step(before);
    int count = 0;
    do {
      feeler.step(after);
    } while (++count < kMostSteps && !felt(feeler.monitor()));
    missed += count == kMostSteps;
    steps.push_back(count);
  }
  std::sort(steps.begin(), steps.end());
  std::fprintf(stderr, "injection: %s %.0f to %.0f nN: median %d ms, nine of ten %d ms, not within 1 s: %d of %d\n",
               what, 1e9 * before, 1e9 * after, steps[steps.size() / 2], steps[steps.size() * 9 / 10], missed, kTrials);
}

}  // namespace

void printDetectionFigures() {
  DetectionConfig config;
  for (const double force : {50e-9, 20e-9, 10e-9}) {
    config.contact_force = force;
    falseTouches(config);
    latencies(config, "a touch that steps the force from", 0, force, [](const auto& m) { return m.touched(); });
  }
  config = {};
  for (const double force : {50e-9, 100e-9, 300e-9, 1e-6, 7.5e-6}) {
    latencies(config, "a puncture from", force, 0.4 * force, [](const auto& m) { return m.punctured(); });
  }
}

}  // namespace microinjection
