#include "cell/estimation/sample_history.h"

#include <gtest/gtest.h>

#include <random>

namespace microinjection {
namespace {

TEST(SampleHistory, ASampleIsTheMeanOfTheReadingsOnItsPath) {
  SampleHistory history({1e-7, 1.0, 100});
  for (int i = 0; i < 25; ++i) history.add(0.001 * i, {0, 0, -1e-8 * i}, i);
  ASSERT_EQ(history.samples().size(), 3u);
  const SampleHistory::Sample& second = history.samples()[1];
  EXPECT_EQ(second.readings, 10);
  EXPECT_NEAR(second.force, 14.5, 1e-12);
  EXPECT_NEAR(second.time, 0.0145, 1e-12);
  EXPECT_NEAR(second.tip.z(), -14.5e-8, 1e-18);
}

TEST(SampleHistory, ATipAtRestHasASampleForEachDuration) {
  SampleHistory history({1e-7, 0.05, 100});
  for (int i = 0; i < 200; ++i) history.add(0.001 * i, {0, 0, 0}, 1);
  EXPECT_EQ(history.samples().size(), 4u);
}

TEST(SampleHistory, ItsLengthIsBoundedAndNothingIsLost) {
  SampleHistory history({1e-8, 1.0, 40});
  double sum = 0;
  constexpr int kReadings = 5000;
  for (int i = 0; i < kReadings; ++i) {
    history.add(0.001 * i, {0, 0, -1e-8 * i}, i % 7);
    sum += i % 7;
  }
  EXPECT_LE(history.samples().size(), 40u);
  int readings = 0;
  double kept = 0;
  for (const auto& sample : history.samples()) {
    readings += sample.readings;
    kept += sample.readings * sample.force;
  }
  EXPECT_EQ(readings, kReadings);
  EXPECT_NEAR(kept, sum, 1e-9 * sum);
}

TEST(SampleHistory, ANeedleThatRestsForAMinuteKeepsThePathOnWhichTheForceRose) {
  SampleHistory history({50e-9, 0.05, 160});
  double time = 0;
  for (int i = 0; i < 250; ++i, time += 1e-3) history.add(time, {0, 0, -20e-9 * i}, i);
  const std::size_t path = history.samples().size();
  ASSERT_GT(path, 80u);
  for (; time < 60; time += 1e-3) history.add(time, {0, 0, -5e-6}, 250);
  std::size_t rising = 0;
  for (const auto& sample : history.samples()) rising += sample.tip.z() > -4.9e-6;
  EXPECT_GT(rising, path / 2);
  EXPECT_LE(history.samples().size(), 160u);
}

TEST(SampleHistory, TheNoiseIsThatOfTheReadingsNotOfTheSlope) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 10e-9);
  SampleHistory history({50e-9, 1.0, 1000});
  EXPECT_EQ(history.noise(), 0);
  for (int i = 0; i < 2000; ++i) history.add(0.001 * i, {0, 0, -20e-9 * i}, 20e-9 * i * 0.02 + noise(random));
  EXPECT_NEAR(history.noise(), 10e-9, 0.5e-9);
}

TEST(SampleHistory, ForgetsWhatIsOld) {
  SampleHistory history({1e-8, 1.0, 100});
  for (int i = 0; i < 50; ++i) history.add(i, {0, 0, -1e-7 * i}, i);
  history.forgetBefore(30);
  EXPECT_EQ(history.samples().front().force, 29);
  EXPECT_EQ(history.samples().size(), 21u);
  history.forgetBefore(1e9);
  EXPECT_EQ(history.samples().size(), 1u);
  history.clear();
  history.forgetBefore(0);
  EXPECT_TRUE(history.samples().empty());
}

}  // namespace
}  // namespace microinjection
