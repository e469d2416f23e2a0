#include "hardware/sensor/force_sensor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s

ForceSensorConfig noiseless() {
  ForceSensorConfig config;
  config.density.setZero();
  config.random_walk.setZero();
  config.drift_rate.setZero();
  config.sensitivity.setIdentity();
  config.sample_rate = 1 / kStep;
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

TEST(ForceSensor, ResponseDoesNotDependOnTheStepsOfItsCaller) {
  ForceSensorConfig config = noiseless();
  config.sample_rate = 7000;
  config.natural_frequency = 300;
  config.damping_ratio = 0.2;
  ForceSensor once(config), often(config);
  const Eigen::Vector2d at_once = once.sample({1e-6, -2e-6}, 0.01);
  Eigen::Vector2d in_steps;
  for (int i = 0; i < 37; ++i) in_steps = often.sample({1e-6, -2e-6}, 0.01 / 37);
  EXPECT_NEAR((at_once - in_steps).norm(), 0, 1e-12);
}

TEST(ForceSensor, HoldsItsReadingBetweenSamples) {
  ForceSensorConfig config = noiseless();
  config.sample_rate = 100;
  ForceSensor sensor(config);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(sensor.sample({1e-6, 0}, kStep)[0], 0) << i;
  for (int i = 9; i < 19; ++i) EXPECT_NEAR(sensor.sample({1e-6, 0}, kStep)[0], 1e-6, 1e-11) << i;
}

TEST(ForceSensor, OverloadStaysUntilReset) {
  ForceSensorConfig config = noiseless();
  ForceSensor sensor(config);
  for (int i = 0; i < 10; ++i) sensor.sample({0.9 * config.overload[0], 0}, kStep);
  EXPECT_FALSE(sensor.overloaded());  // saturated for long, but unharmed
  sensor.sample({0, -1.5 * config.overload[1]}, kStep);
  EXPECT_TRUE(sensor.overloaded());
  for (int i = 0; i < 100; ++i) sensor.sample({0, 0}, kStep);
  EXPECT_TRUE(sensor.overloaded());
  sensor.reset();
  EXPECT_FALSE(sensor.overloaded());
  sensor.sample({0, 0}, kStep);
  EXPECT_FALSE(sensor.overloaded());
}

TEST(ForceSensor, RefusesAnOverloadBelowTheRange) {
  ConfigReader reader(YAML::Load("{axial_range: 1.0e-3, axial_overload: 0.5e-3}"), "test");
  ForceSensorConfig::read(reader);
  try {
    reader.finish();
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("axial_overload = 0.5e-3: must not be below"), std::string::npos)
        << error.what();
  }
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
  config.sensitivity << 1, 0.03, 0.02, 1;
  ForceSensor sensor(config);
  Eigen::Vector2d reading;
  for (int i = 0; i < 100; ++i) reading = sensor.sample({100e-6, 0}, kStep);
  EXPECT_NEAR(reading[0], 100e-6, 1e-9);
  EXPECT_NEAR(reading[1], 2e-6, 1e-9);
  for (int i = 0; i < 100; ++i) reading = sensor.sample({0, 100e-6}, kStep);
  EXPECT_NEAR(reading[0], 3e-6, 1e-9);
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
