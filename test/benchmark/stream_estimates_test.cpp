// The sensor's stream against its configuration, within 5 %. The streams are long enough that the statistical error is
// well below that; seeds are fixed.
#include "benchmark/common/stream_estimates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hardware/sensor/stream.h"

namespace microinjection {
namespace {

constexpr double kWithin = 0.05;

void expectWithin(double estimated, double configured) {
  EXPECT_NEAR(estimated, configured, kWithin * std::abs(configured));
}

ForceSensorConfig noisyOnly() {
  ForceSensorConfig config;
  config.random_walk.setZero();
  config.drift_rate.setZero();
  config.bits = 24;
  return config;
}

TEST(StreamEstimates, WhiteNoiseHasItsDensityOverTheWholeBand) {
  const ForceSensorConfig config = noisyOnly();
  for (int axis = 0; axis < 2; ++axis) {
    ForceSensor sensor(config);
    const auto readings = stream(sensor, {0, 0}, 1e-4, 200000, axis);
    for (const double from : {50.0, 1000.0, 4000.0}) {
      expectWithin(noiseDensity(readings, 1e4, 1024, from, from + 900), config.density[axis]);
    }
    // What the density means for a sample: its square times half of the sample rate.
    expectWithin(std::sqrt(readings.squaredNorm() / 200000), config.density[axis] * std::sqrt(5000));
  }
}

TEST(StreamEstimates, TheDensityDoesNotDependOnTheSampleRate) {
  ForceSensorConfig config = noisyOnly();
  config.sample_rate = 2500;
  ForceSensor sensor(config);
  expectWithin(noiseDensity(stream(sensor, {0, 0}, 4e-4, 200000, 0), 2500, 1024, 20, 1200), config.density[0]);
}

TEST(StreamEstimates, FlickerNoiseRisesBelowItsCorner) {
  ForceSensorConfig config = noisyOnly();
  config.sample_rate = 1000;
  config.flicker_corner = 50;
  ForceSensor sensor(config);
  const auto readings = stream(sensor, {0, 0}, 1e-3, 1000000, 0);
  for (const double f : {2.0, 5.0, 20.0, 50.0, 200.0}) {
    // Over a narrow band the mean of 1 + fc/f is close to that at its geometric middle.
    const double density = config.density[0] * std::sqrt(1 + 50 / f);
    EXPECT_NEAR(noiseDensity(readings, 1000, 8192, f / 1.15, f * 1.15), density, kWithin * density) << f << " Hz";
  }
}

TEST(StreamEstimates, RoundingAddsItsOwnDensity) {
  ForceSensorConfig config = noisyOnly();
  config.bits = 16;
  ForceSensor sensor(config);
  const auto readings = stream(sensor, {0, 0}, 1e-4, 200000, 0);
  const double step = quantisationStep(readings);
  expectWithin(step, 2 * config.range[0] / 65536);
  const double both = noiseDensity(readings, 1e4, 1024, 100, 4900);
  EXPECT_GT(both, 1.05 * config.density[0]);
  const double rounding = roundingDensity(step, 1e4);
  expectWithin(std::sqrt(both * both - rounding * rounding), config.density[0]);
}

TEST(StreamEstimates, StepResponseGivesFrequencyAndDamping) {
  for (const double damping : {0.05, 0.7, 1.5}) {
    ForceSensorConfig config = noisyOnly();
    config.natural_frequency = 400;
    config.damping_ratio = damping;
    ForceSensor sensor(config);
    const SecondOrder found = secondOrderOfStep(stream(sensor, {200e-6, 0}, 1e-4, 4000, 0), 1e4);
    expectWithin(found.natural_frequency, 400);
    expectWithin(found.damping_ratio, damping);
  }
}

TEST(StreamEstimates, DriftIsToldFromWhiteNoise) {
  ForceSensorConfig config = noisyOnly();
  config.sample_rate = 100;
  config.random_walk = {0.5e-9, 0};
  config.drift_rate = {0.5e-9, 2e-9};
  ForceSensor sensor(config);
  constexpr int kBlocks = 8000;  // of 1 s
  Eigen::Matrix2Xd means(2, kBlocks);
  for (int block = 0; block < kBlocks; ++block) {
    Eigen::Vector2d sum(0, 0);
    for (int i = 0; i < 100; ++i) sum += sensor.sample({0, 0}, 0.01);
    means.col(block) = sum / 100;
  }
  const DriftFigures axial = driftOf(means.row(0), 1, config.density[0]);
  expectWithin(axial.rate, 0.5e-9);
  expectWithin(axial.random_walk, 0.5e-9);
  expectWithin(driftOf(means.row(1), 1, config.density[1]).rate, 2e-9);
}

}  // namespace
}  // namespace microinjection
