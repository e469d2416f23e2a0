#include "vision/calibration/tip_focus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "benchmark/common/simulated_needle.h"

namespace microinjection {
namespace {

/// Planes 1 um apart from -8 um to 8 um, and a bell of sharpness.
struct Planes {
  double focus = 0.3e-6, width = 2.5e-6, noise = 0.02, foot = 1, peak = 1;
  int count = 17;
  bool lorentzian = false;  ///< another shape than the one that is fitted

  std::vector<FocusSample> make(SimulatedNeedle& random) const {
    std::vector<FocusSample> samples;
    for (int i = 0; i < count; ++i) {
      const double height = 1e-6 * (i - 8), u = (height - focus) / width;
      const double shape = lorentzian ? 1 / (1 + u * u) : std::exp(-0.5 * u * u);
      samples.push_back({height, foot + peak * shape + noise * random.normal()});
    }
    return samples;
  }
};

class TipFocus : public ::testing::Test {
 protected:
  SimulatedNeedle random{drawnNeedle(51), Eigen::Vector3d::Zero()};
  TipFocusConfig config;
};

TEST_F(TipFocus, IsWithin300NanometresWithItsInterval) {
  int held = 0;
  constexpr int kTrials = 2000;
  for (int i = 0; i < kTrials; ++i) {
    Planes planes;
    planes.focus = 4e-6 * (2 * random.uniform() - 1);
    const FocusReport report = findFocus(planes.make(random), config);
    ASSERT_EQ(report.verdict, FocusVerdict::kFocus) << report.text;
    EXPECT_NEAR(report.height, planes.focus, 0.3e-6);
    held += report.interval.contains(planes.focus) ? 1 : 0;
  }
  EXPECT_GT(held, 0.93 * kTrials);
  EXPECT_LT(held, 0.97 * kTrials);
}

TEST_F(TipFocus, AnotherShapeIsWithin300NanometresToo) {
  for (int i = 0; i < 200; ++i) {
    Planes planes;
    planes.lorentzian = true;
    planes.focus = 3e-6 * (2 * random.uniform() - 1);
    const FocusReport report = findFocus(planes.make(random), config);
    ASSERT_EQ(report.verdict, FocusVerdict::kFocus) << report.text;
    EXPECT_NEAR(report.height, planes.focus, 0.3e-6);
  }
}

TEST_F(TipFocus, OneBadPlaneIsLeftOut) {
  for (const int plane : {2, 6, 8, 11}) {
    std::vector<FocusSample> samples = Planes().make(random);
    samples[plane].sharpness += 3;  // dust in this plane
    const FocusReport report = findFocus(samples, config);
    EXPECT_NEAR(report.height, 0.3e-6, 0.3e-6) << plane << report.text;
  }
}

TEST_F(TipFocus, TheOrderOfThePlanesDoesNotMatter) {
  std::vector<FocusSample> samples = Planes().make(random);
  const double height = findFocus(samples, config).height;
  std::swap(samples[3], samples[12]);
  std::swap(samples[0], samples[16]);
  EXPECT_EQ(findFocus(samples, config).height, height);
}

TEST_F(TipFocus, APeakAtTheBorderSaysWhichPlanesToAdd) {
  for (const double focus : {-12e-6, -8e-6, 7.8e-6, 11e-6}) {
    Planes planes;
    planes.focus = focus;
    const FocusReport report = findFocus(planes.make(random), config);
    EXPECT_EQ(report.verdict, FocusVerdict::kBorder) << focus << report.text;
    EXPECT_EQ(report.towards, focus > 0 ? 1 : -1);
  }
}

TEST_F(TipFocus, WithoutAPeakThereIsNone) {
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    Planes planes;
    planes.peak = 0;
    planes.noise = i % 2 == 0 ? 0.02 : 0.3;
    found += findFocus(planes.make(random), config).verdict == FocusVerdict::kFocus ? 1 : 0;
  }
  EXPECT_LE(found, 3);
}

TEST_F(TipFocus, TwoPeaksAreUnsure) {
  Planes first, second;
  first.focus = 4e-6;
  first.width = 1.5e-6;
  second.focus = -6e-6;
  second.width = 1e-6;
  std::vector<FocusSample> samples = first.make(random);
  const std::vector<FocusSample> other = second.make(random);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].sharpness += other[i].sharpness;
  const FocusReport report = findFocus(samples, config);
  EXPECT_EQ(report.verdict, FocusVerdict::kUnsure);
  EXPECT_EQ(report.text.find("two peaks"), 0u) << report.text;
}

TEST_F(TipFocus, ATransparentTipIsInFocusBetweenItsTwoPeaks) {
  for (int i = 0; i < 100; ++i) {
    Planes before, behind;
    before.width = behind.width = 1.2e-6;
    before.focus = -2e-6;
    behind.focus = 2.2e-6;
    std::vector<FocusSample> samples = before.make(random);
    const std::vector<FocusSample> other = behind.make(random);
    for (std::size_t k = 0; k < samples.size(); ++k) samples[k].sharpness += other[k].sharpness;
    const FocusReport report = findFocus(samples, config);
    ASSERT_EQ(report.verdict, FocusVerdict::kUnsure) << report.text;
    EXPECT_NEAR(report.height, 0.1e-6, 0.7e-6) << report.text;
  }
}

TEST_F(TipFocus, AVagueHeightIsUnsure) {
  config.largest_interval = 0.01e-6;
  const FocusReport report = findFocus(Planes().make(random), config);
  EXPECT_EQ(report.verdict, FocusVerdict::kUnsure);
  EXPECT_EQ(report.text.find("the height is vague"), 0u) << report.text;
}

TEST_F(TipFocus, RefusesUnusableSamples) {
  std::vector<FocusSample> samples = Planes().make(random);
  samples.resize(6);
  EXPECT_EQ(findFocus(samples, config).text, "planes = 6: must be at least 7");
  samples = Planes().make(random);
  samples[4].height = samples[5].height;
  EXPECT_EQ(findFocus(samples, config).text, "two planes have the same height");
  samples[4].sharpness = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(findFocus(samples, config).verdict, FocusVerdict::kInvalid);
}

}  // namespace
}  // namespace microinjection
