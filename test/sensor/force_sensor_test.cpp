#include "sensor/force_sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s

ForceSensorConfig noiseless() {
  ForceSensorConfig config;
  config.axial_noise = config.lateral_noise = config.cross_axis = 0;
  config.bits = 32;
  return config;
}

TEST(ForceSensor, StepResponseIsThatOfTheSecondOrderSystem) {
  ForceSensorConfig config = noiseless();
  config.natural_frequency = 50;
  config.damping_ratio = 0.3;
  ForceSensor sensor(config);
  const double omega = 2 * M_PI * 50, zeta = 0.3, damped = omega * std::sqrt(1 - zeta * zeta);
  for (int i = 1; i <= 40; ++i) {
    const double t = i * kStep;
    const double exact =
        1 - std::exp(-zeta * omega * t) * (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t));
    EXPECT_NEAR(sensor.sample({1e-6, 0}, kStep)[0], 1e-6 * exact, 1e-11) << "at " << t;
  }
}

TEST(ForceSensor, NoiseHasTheStatedSizeAndNoBias) {
  ForceSensorConfig config;
  config.bits = 32;
  ForceSensor sensor(config);
  const int n = 20000;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), squares = Eigen::Vector2d::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector2d reading = sensor.sample({0, 0}, kStep);
    sum += reading;
    squares += reading.cwiseAbs2();
  }
  // Standard errors: 1/sqrt(n) of the mean, 1/sqrt(2 n) of the deviation; five of them.
  EXPECT_NEAR(sum[0] / n, 0, 5 * 10e-9 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares[0] / n), 10e-9, 5 * 10e-9 / std::sqrt(2.0 * n));
  EXPECT_NEAR(std::sqrt(squares[1] / n), 240e-9, 5 * 240e-9 / std::sqrt(2.0 * n));
}

TEST(ForceSensor, SameSeedSameReadings) {
  ForceSensorConfig config;
  ForceSensor a(config), b(config);
  config.seed = 2;
  ForceSensor c(config);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d reading = a.sample({1e-6, 0}, kStep);
    EXPECT_EQ(reading, b.sample({1e-6, 0}, kStep));
    differs = differs || reading != c.sample({1e-6, 0}, kStep);
  }
  EXPECT_TRUE(differs);
}

TEST(ForceSensor, EachAxisShowsItsShareOnTheOther) {
  ForceSensorConfig config = noiseless();
  config.cross_axis = 0.02;
  ForceSensor sensor(config);
  Eigen::Vector2d reading;
  for (int i = 0; i < 100; ++i) reading = sensor.sample({100e-6, 0}, kStep);
  EXPECT_NEAR(reading[0], 100e-6, 1e-9);
  EXPECT_NEAR(reading[1], 2e-6, 1e-9);
}

TEST(ForceSensor, SaturatesAtItsRangeAndSaysSo) {
  ForceSensor sensor(noiseless());
  Eigen::Vector2d reading;
  for (int i = 0; i < 100; ++i) reading = sensor.sample({400e-6, 0}, kStep);
  EXPECT_FALSE(sensor.saturated());
  for (int i = 0; i < 100; ++i) reading = sensor.sample({600e-6, 0}, kStep);
  EXPECT_TRUE(sensor.saturated());
  EXPECT_DOUBLE_EQ(reading[0], 490e-6);
}

TEST(ForceSensor, QuantisesToItsBits) {
  ForceSensorConfig config = noiseless();
  config.bits = 8;
  ForceSensor sensor(config);
  Eigen::Vector2d reading;
  for (int i = 0; i < 100; ++i) reading = sensor.sample({5e-6, 0}, kStep);
  const double quantum = 2 * 490e-6 / 256;
  EXPECT_NEAR(reading[0], quantum * std::round(5e-6 / quantum), 1e-12);
}

}  // namespace
}  // namespace microinjection
