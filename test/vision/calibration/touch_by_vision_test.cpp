#include "vision/calibration/touch_by_vision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "benchmark/common/simulated_needle.h"

namespace microinjection {
namespace {

/// An approach from 20 um downwards in steps of 0.5 um. The tip moves 7 px/um down the image; once it
/// touches at `touch` (m) it is deflected by `slope` (px/um) to the side and held back in its way.
struct Approach {
  double touch = 8e-6, slope = 2, noise = 0.2, outlier_share = 0;
  int samples = 40;

  std::vector<TouchSample> make(SimulatedNeedle& random) const {
    std::vector<TouchSample> series;
    for (int i = 0; i < samples; ++i) {
      const double height = 20e-6 - 0.5e-6 * i, pressed = 1e6 * std::max(0.0, touch - height);
      TouchSample sample{height, Eigen::Vector2d(600 + slope * pressed, 400 - 7e6 * height - 0.5 * slope * pressed)};
      sample.pixel += noise * Eigen::Vector2d(random.normal(), random.normal());
      if (random.uniform() < outlier_share) sample.pixel += 40 * Eigen::Vector2d(random.normal(), random.normal());
      series.push_back(sample);
    }
    return series;
  }
};

class TouchByVision : public ::testing::Test {
 protected:
  SimulatedNeedle random{drawnNeedle(41), Eigen::Vector3d::Zero()};
  TouchByVisionConfig config;
};

TEST_F(TouchByVision, FindsTheTouchWithin500Nanometres) {
  for (const double outliers : {0.0, 0.05}) {
    for (int i = 0; i < 50; ++i) {
      Approach approach;
      approach.outlier_share = outliers;
      approach.touch = 4e-6 + 10e-6 * random.uniform();
      const TouchReport report = findTouch(approach.make(random), config);
      ASSERT_EQ(report.verdict, TouchVerdict::kTouch) << report.text;
      EXPECT_NEAR(report.height, approach.touch, 0.3e-6);
      EXPECT_NEAR(report.change, std::sqrt(1.25) * 2e6, 0.15e6);
    }
  }
}

TEST_F(TouchByVision, IntervalsCover) {
  for (const double slope : {0.5, 2.0}) {
    int held = 0;
    constexpr int kTrials = 500;
    for (int i = 0; i < kTrials; ++i) {
      Approach approach;
      approach.slope = slope;
      approach.touch = 6e-6 + 6e-6 * random.uniform();
      held += findTouch(approach.make(random), config).interval.contains(approach.touch) ? 1 : 0;
    }
    EXPECT_GT(held, 0.93 * kTrials) << slope;
    EXPECT_LT(held, 0.97 * kTrials) << slope;
  }
}

TEST_F(TouchByVision, OneCoordinateWithKnownDeviationsHasTrueIntervals) {
  int held = 0, weighted_better = 0;
  constexpr int kTrials = 300;
  for (int i = 0; i < kTrials; ++i) {
    Approach approach;
    approach.touch = 6e-6 + 6e-6 * random.uniform();
    std::vector<TouchSample> samples = approach.make(random);
    for (TouchSample& each : samples) {
      each.deviation = random.uniform() < 0.3 ? 1.5 : 0.3;
      each.pixel.x() += each.deviation * random.normal();
      each.pixel.y() = 1e3 * random.normal();  // not measured
    }
    const TouchReport report = findTouch(samples, config, TouchCoordinates::kOne);
    held += report.interval.contains(approach.touch) ? 1 : 0;
    for (TouchSample& each : samples) each.deviation = 1;
    const TouchReport plain = findTouch(samples, config, TouchCoordinates::kOne);
    weighted_better += std::abs(report.height - approach.touch) < std::abs(plain.height - approach.touch) ? 1 : 0;
  }
  EXPECT_GT(held, 0.92 * kTrials);
  EXPECT_LT(held, 0.98 * kTrials);
  EXPECT_GT(weighted_better, 0.55 * kTrials);
}

TEST_F(TouchByVision, NoTouchInThisRangeIsAnAnswer) {
  Approach approach;
  approach.touch = -1;
  int touches = 0;
  for (int i = 0; i < 500; ++i) {
    const TouchReport report = findTouch(approach.make(random), config);
    touches += report.verdict == TouchVerdict::kNoTouch ? 0 : 1;
  }
  EXPECT_LE(touches, 3);
}

TEST_F(TouchByVision, NoTouchIsFoundAmongOutliers) {
  Approach approach;
  approach.touch = -1;
  approach.outlier_share = 0.1;
  int touches = 0;
  for (int i = 0; i < 200; ++i) {
    touches += findTouch(approach.make(random), config).verdict == TouchVerdict::kTouch ? 1 : 0;
  }
  EXPECT_LE(touches, 2);
}

TEST_F(TouchByVision, UpwardsIsAsGoodAsDownwards) {
  std::vector<TouchSample> samples = Approach().make(random);
  for (TouchSample& each : samples) each.height = -each.height;
  const TouchReport report = findTouch(samples, config);
  ASSERT_EQ(report.verdict, TouchVerdict::kTouch) << report.text;
  EXPECT_NEAR(report.height, -8e-6, 0.3e-6);
  EXPECT_TRUE(report.interval.contains(report.height));
}

TEST_F(TouchByVision, IsUnsureTooCloseToAnEnd) {
  Approach approach;
  approach.touch = 19.2e-6;
  const TouchReport report = findTouch(approach.make(random), config);
  EXPECT_EQ(report.verdict, TouchVerdict::kUnsure);
  EXPECT_NE(report.text.find("too close to an end"), std::string::npos) << report.text;
}

TEST_F(TouchByVision, ASmallBendIsNoTouch) {
  Approach approach;
  approach.slope = 0.05;
  approach.noise = 0.01;
  const TouchReport report = findTouch(approach.make(random), config);
  EXPECT_EQ(report.verdict, TouchVerdict::kNoTouch);
  EXPECT_NE(report.text.find("the bend moves the last sample by"), std::string::npos) << report.text;
}

TEST_F(TouchByVision, IsUnsureWhenTheHeightIsVague) {
  config.largest_interval = 0.02e-6;
  const TouchReport report = findTouch(Approach().make(random), config);
  EXPECT_EQ(report.verdict, TouchVerdict::kUnsure);
  EXPECT_NE(report.text.find("the height is vague"), std::string::npos) << report.text;
}

TEST_F(TouchByVision, RefusesUnusableSamples) {
  std::vector<TouchSample> samples = Approach().make(random);
  samples.resize(9);
  EXPECT_EQ(findTouch(samples, config).text, "samples = 9: must be at least 10");
  samples = Approach().make(random);
  std::swap(samples[3], samples[4]);
  EXPECT_EQ(findTouch(samples, config).text, "height 4: the heights must go in one direction");
  samples[3].pixel.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(findTouch(samples, config).text, "a height or a pixel is not finite");
  samples = Approach().make(random);
  samples[3].deviation = 0;
  EXPECT_EQ(findTouch(samples, config).text, "a deviation is not positive and finite");
  EXPECT_EQ(findTouch({}, config).verdict, TouchVerdict::kInvalid);
}

}  // namespace
}  // namespace microinjection
