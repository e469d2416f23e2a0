#include "benchmark/common/faulty_sensor.h"

#include "benchmark/common/drawn_cell.h"

namespace microinjection {
namespace {

constexpr double kOutliers = 0.03, kDropouts = 0.01, kFreezes = 0.002;  // of the readings
constexpr int kDropout = 20, kFreeze = 30;                              // readings
constexpr int kSamples = 10;                                            // of the converter, for a reading

ForceSensorConfig seeded(int seed, double noise) {
  ForceSensorConfig config;
  config.density *= noise;
  config.range *= noise;  // the converter's step is as fine
  config.seed = seed;
  return config;
}

}  // namespace

FaultySensor::FaultySensor(const std::string& fault, double outlier, int seed, double noise)
    : fault_(fault), outlier_(outlier), sensor_(seeded(seed, noise)) {}

std::optional<double> FaultySensor::read(double time, const std::function<double(double)>& force,
                                         std::mt19937& random) {
  const double period = 1 / (kRate * kSamples);
  double reading = 0;
  for (int k = 1; k <= kSamples; ++k) {
    reading = sensor_.sample({force(time + (k - kSamples) * period), 0}, period)[0];
  }
  if (fault_ == "outliers" && uniform(0, 1, random) < kOutliers) {
    reading += uniform(0, 1, random) < 0.5 ? -outlier_ : outlier_;
  }
  if (fault_ == "dropouts" && uniform(0, 1, random) < kDropouts) hold_ = kDropout;
  if (fault_ == "freeze" && hold_ == 0 && uniform(0, 1, random) < kFreezes) {
    hold_ = kFreeze;
    frozen_ = reading;
  }
  if (hold_ == 0) return reading;
  --hold_;
  return fault_ == "freeze" ? std::optional(frozen_) : std::nullopt;
}

}  // namespace microinjection
