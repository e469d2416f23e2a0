#include "cell/identification/frozen_readings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace microinjection {
namespace {

/// A force that grows by 100 nN/s with a noise of 1 nN.
ForceCurve ramp(double converter_step = 0) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  ForceCurve curve;
  for (int i = 0; i < 500; ++i) {
    double force = 1e-10 * i + 1e-9 * normal(random);
    if (converter_step > 0) force = converter_step * std::round(force / converter_step);
    curve.time.push_back(1e-3 * i);
    curve.position.push_back(20e-9 * i);
    curve.force.push_back(force);
  }
  return curve;
}

TEST(FrozenReadings, OfASensorThatHungTheFirstStays) {
  ForceCurve curve = ramp();
  for (std::size_t i = 301; i < 380; ++i) curve.force[i] = curve.force[300];
  const ForceCurve left = withoutFrozenReadings(curve);
  ASSERT_EQ(left.size(), 500U - 79);
  EXPECT_EQ(left.time[300], curve.time[300]);
  EXPECT_EQ(left.time[301], curve.time[380]);
  EXPECT_EQ(left.position[301], curve.position[380]);
  EXPECT_EQ(left.notes.size(), 1U);
}

TEST(FrozenReadings, ASensorThatHangsToTheEndIsLeftOut) {
  ForceCurve curve = ramp();
  for (std::size_t i = 301; i < 500; ++i) curve.force[i] = curve.force[300];
  EXPECT_EQ(withoutFrozenReadings(curve).size(), 301U);
  for (std::size_t i = 301; i < 500; ++i) curve.position[i] = curve.position[300];
  EXPECT_EQ(withoutFrozenReadings(curve).size(), 500U) << "at rest the force may stay";
}

TEST(FrozenReadings, ACoarseConverterIsNotFrozen) {
  // Steps of twenty times the noise: most readings equal the one before.
  EXPECT_EQ(withoutFrozenReadings(ramp(20e-9)).size(), 500U);
  EXPECT_TRUE(withoutFrozenReadings(ramp()).notes.empty());
}

}  // namespace
}  // namespace microinjection
