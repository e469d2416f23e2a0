#include "cell/estimation/reading_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace microinjection {
namespace {

using Verdict = ReadingFilter::Verdict;
constexpr double kNoise = 10e-9;  // N

/// Share of 2000 readings of a ramp (N/s) that are good, and their mean distance from it (N).
std::pair<double, double> ramp(double rate, double slope) {
  ReadingFilter filter;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, kNoise);
  int good = 0;
  double off = 0;
  for (int i = 0; i < 2000; ++i) {
    const double time = i / rate, error = noise(random);
    if (filter.judge(time, slope * time + error, kNoise) != Verdict::kGood) continue;
    ++good;
    off += error;
  }
  return {good / 2000.0, off / good};
}

TEST(ReadingFilter, ASteadyChangeIsGoodAtAnyRate) {
  // Stiff cells at 60 um/s and 1 kHz, at 20 um/s and 100 Hz.
  for (const auto& [rate, slope] : {std::pair(1000.0, 23e-6), std::pair(100.0, 8e-6), std::pair(1000.0, 0.0)}) {
    const auto [good, off] = ramp(rate, slope);
    EXPECT_GT(good, 0.98) << rate;
    EXPECT_LT(std::abs(off), 1e-9) << rate;
  }
}

TEST(ReadingFilter, ASingleReadingThatIsFarOffIsAnOutlier) {
  ReadingFilter filter;
  for (int i = 0; i < 40; ++i) {
    const bool off = i % 10 == 9;
    const Verdict verdict = filter.judge(0.001 * i, (off ? 1e-6 : 0) + 1e-9 * std::sin(i), kNoise);
    if (i >= 6) {
      EXPECT_EQ(verdict, off ? Verdict::kOutlier : Verdict::kGood) << i;
    }
  }
  EXPECT_EQ(filter.complaint(), "");
}

TEST(ReadingFilter, ARepeatedReadingIsFrozenUntilItChanges) {
  ReadingFilter filter;
  for (int i = 0; i < 50; ++i) filter.judge(0.001 * i, 1e-7, kNoise);
  EXPECT_EQ(filter.judge(0.05, 1e-7, kNoise), Verdict::kFrozen);
  EXPECT_NE(filter.complaint().find("repeats the same reading"), std::string::npos);
  EXPECT_EQ(filter.judge(0.051, 1.01e-7, kNoise), Verdict::kGood);
  EXPECT_EQ(filter.complaint(), "");
}

TEST(ReadingFilter, ComplainsOfReadingsThatJump) {
  ReadingFilter filter;
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) filter.judge(0.001 * i, (random() % 2 == 0 ? 1 : -1) * 1e-6 * i, 1e-12);
  EXPECT_NE(filter.complaint().find("jump"), std::string::npos);
}

TEST(ReadingFilter, NothingIsKnownOfTheFirstReadings) {
  ReadingFilter filter;
  EXPECT_EQ(filter.judge(0, 1, kNoise), Verdict::kUnknown);
  EXPECT_EQ(filter.judge(0, std::nan(""), kNoise), Verdict::kUnknown);
}

}  // namespace
}  // namespace microinjection
