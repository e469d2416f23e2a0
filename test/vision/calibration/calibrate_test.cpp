#include "vision/calibration/calibrate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vision/calibration/calibration_trial.h"

namespace microinjection {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The observations of a drawn needle.
std::vector<TipObservation> observationsOf(const SimulatedNeedleConfig& truth, bool focus = false) {
  return needleOf(truth).observe(testWaypoints(focus));
}

std::string refusalsOf(const std::vector<TipObservation>& observations, const CalibrationLimits& limits = {}) {
  const CalibrationOutcome outcome = calibrate(observations, limits, testSetup());
  EXPECT_EQ(outcome.calibration.has_value(), outcome.refusals.empty());
  std::string all;
  for (const std::string& refusal : outcome.refusals) all += refusal + '\n';
  return all;
}

TEST(Calibrate, FindsTheTruthWithoutNoise) {
  for (int seed = 1; seed <= 20; ++seed) {
    SimulatedNeedleConfig truth = drawnNeedle(seed);
    truth.noise = truth.focus_noise = 0;
    SimulatedNeedle needle = needleOf(truth);
    const CalibrationOutcome outcome = calibrateNeedle(needle, true);
    ASSERT_TRUE(outcome.calibration) << outcome.refusals.front();
    EXPECT_EQ(outcome.calibration->mirrored, truth.mirrored);
    const CalibrationVector<double> value = trueValue(truth, needle, *outcome.calibration);
    for (int i = 0; i < kCalibrationParameters; ++i) {
      const double scale = i == kPixelSize ? 1e-7 : i >= kBacklashX && i <= kBacklashZ ? 1e-6 : 1;
      EXPECT_NEAR(outcome.calibration->value[i] / scale, value[i] / scale, 1e-6) << kCalibrationNames[i].name << seed;
    }
  }
}

TEST(Calibrate, ReachesItsFiguresWithNoise) {
  for (int seed = 1; seed <= 100; ++seed) {
    const SimulatedNeedleConfig truth = drawnNeedle(seed);
    const CalibrationOutcome outcome = calibrate(observationsOf(truth), {}, testSetup());
    ASSERT_TRUE(outcome.calibration) << outcome.refusals.front();
    const CalibrationVector<double>& value = outcome.calibration->value;
    EXPECT_NEAR(value[kPixelSize] / truth.value[kPixelSize], 1, 1e-3) << seed;
    EXPECT_NEAR(value[kAngle], truth.value[kAngle], 0.05 * 3.14159265 / 180) << seed;
    EXPECT_NEAR(outcome.calibration->residual, 0.2, 0.05);
    EXPECT_GE(outcome.calibration->points, 59);  // a good tip lies beyond 4.5 deviations once in 25 000
  }
}

/// Share of 95 % intervals that hold the truth, over trials and parameters.
struct Coverage {
  int held = 0, all = 0;
  void add(bool good) { held += good ? 1 : 0, ++all; }
  double share() const { return static_cast<double>(held) / all; }
};

/// With 1000 trials the deviation of a parameter's share is 0.7 %, with 4000 it is 0.35 %.
void checkCoverage(int trials, double outlier_share, bool focus, double stated_deviation) {
  Coverage whole;
  std::array<Coverage, kCalibrationParameters> each;
  for (int seed = 1; seed <= trials; ++seed) {
    SimulatedNeedleConfig truth = drawnNeedle(10000 + seed);
    truth.outlier_share = outlier_share;
    SimulatedNeedle needle = needleOf(truth);
    std::vector<TipObservation> observations = needle.observe(testWaypoints(focus));
    for (TipObservation& observation : observations) {
      observation.covariance = stated_deviation * stated_deviation * Eigen::Matrix2d::Identity();
    }
    const CalibrationOutcome outcome = calibrate(observations, {}, testSetup());
    ASSERT_TRUE(outcome.calibration) << outcome.refusals.front();
    const CalibrationVector<double> value = trueValue(truth, needle, *outcome.calibration);
    for (int i = 0; i < kCalibrationParameters; ++i) {
      if (!outcome.calibration->estimated[i]) continue;
      const bool held = outcome.calibration->interval(static_cast<CalibrationParameter>(i)).contains(value[i]);
      whole.add(held);
      each[i].add(held);
    }
  }
  EXPECT_GT(whole.share(), 0.94);
  EXPECT_LT(whole.share(), 0.96);
  for (int i = 0; i < kCalibrationParameters; ++i) {
    if (each[i].all == 0) continue;
    EXPECT_GT(each[i].share(), 0.93) << kCalibrationNames[i].name;
    EXPECT_LT(each[i].share(), 0.97) << kCalibrationNames[i].name;
  }
}

TEST(Calibrate, IntervalsCover95Percent) { checkCoverage(1000, 0, false, 0.2); }
TEST(Calibrate, IntervalsCoverWhenTheStatedNoiseIsThreeTimesTooSmall) { checkCoverage(500, 0, false, 0.2 / 3); }
TEST(Calibrate, IntervalsCoverWithOutliers) { checkCoverage(1000, 0.05, false, 0.2); }
TEST(Calibrate, IntervalsCoverWithFocusReadings) { checkCoverage(1500, 0, true, 0.3); }

TEST(Calibrate, NamesTheOutliers) {
  std::vector<TipObservation> observations = observationsOf(drawnNeedle(3));
  *observations[7].pixel += Eigen::Vector2d(3, 0);
  *observations[40].pixel += Eigen::Vector2d(0, -500);
  const CalibrationOutcome outcome = calibrate(observations, {}, testSetup());
  ASSERT_TRUE(outcome.calibration);
  EXPECT_EQ(outcome.outliers, (std::vector<int>{7, 40}));
  EXPECT_EQ(outcome.calibration->points, 58);
}

TEST(Calibrate, UsesMovesSmallerThanTheBacklash) {
  SimulatedNeedleConfig truth = drawnNeedle(4);
  truth.noise = 0;
  std::vector<CalibrationWaypoint> waypoints = testWaypoints();
  const Eigen::Vector3d last = waypoints.back().position;
  for (const double x : {0.7e-6, 1.6e-6, 2.6e-6, 1.5e-6, 0.1e-6}) {
    waypoints.push_back({last + Eigen::Vector3d(x, 0, 0), true, false});
  }
  SimulatedNeedle needle(truth, Eigen::Vector3d::Zero());
  const CalibrationOutcome outcome = calibrate(needle.observe(waypoints), {}, testSetup());
  ASSERT_TRUE(outcome.calibration) << outcome.refusals.front();
  EXPECT_EQ(outcome.calibration->points, 65);
  EXPECT_LT(outcome.calibration->residual, 1e-6);
  EXPECT_NEAR(outcome.calibration->value[kBacklashX], 2e-6, 1e-11);
}

TEST(Calibrate, FindsTheMotionThatChangesFocusOnly) {
  const SimulatedNeedleConfig truth = drawnNeedle(8);
  const CalibrationOutcome outcome = calibrate(observationsOf(truth, true), {}, testSetup());
  ASSERT_TRUE(outcome.calibration) << outcome.refusals.front();
  const Eigen::Vector3d motion = *outcome.calibration->focusMotion();
  EXPECT_LT((imageAxes(truth.value, truth.mirrored) * motion).norm() * truth.value[kPixelSize], 0.02);
  EXPECT_NEAR(truth.value.segment<3>(kFocusX).dot(motion), 1, 0.02);
}

TEST(Calibrate, WithoutFocusReadingsThereIsNoFocusMotion) {
  const CalibrationOutcome outcome = calibrate(observationsOf(drawnNeedle(8)), {}, testSetup());
  ASSERT_TRUE(outcome.calibration);
  EXPECT_FALSE(outcome.calibration->focusMotion());
  EXPECT_FALSE(outcome.calibration->focusOf(Eigen::Vector3d::Zero()));
}

TEST(Calibrate, RefusesAFlipAgainstTheConfiguration) {
  SimulatedNeedleConfig truth = drawnNeedle(1);
  for (const bool mirrored : {false, true}) {
    truth.mirrored = mirrored;
    CalibrationLimits limits;
    limits.mirror = mirrored ? "no" : "yes";
    EXPECT_EQ(refusalsOf(observationsOf(truth), limits),
              mirrored ? "mirrored = yes: must be no, as configured: the image is flipped\n"
                       : "mirrored = no: must be yes, as configured: the image is flipped\n");
    limits.mirror = mirrored ? "yes" : "no";
    EXPECT_EQ(refusalsOf(observationsOf(truth), limits), "");
  }
}

TEST(Calibrate, RefusesTooFewPoints) {
  std::vector<TipObservation> observations = observationsOf(drawnNeedle(1));
  observations.resize(12);
  EXPECT_EQ(refusalsOf(observations), "points = 11: must be at least 12, seen after each axis took up its play\n");
  EXPECT_NE(refusalsOf({}).find("points = 0"), std::string::npos);
}

TEST(Calibrate, RefusesPointsOnOneLine) {
  const SimulatedNeedleConfig truth = drawnNeedle(1);
  std::vector<CalibrationWaypoint> waypoints;
  for (const int way : {1, -1}) {
    for (int i = -10; i <= 10; ++i) waypoints.push_back({way * i * Eigen::Vector3d(8e-6, 0, 6.1e-6), true, false});
  }
  SimulatedNeedle needle(truth, waypoints.front().position);
  EXPECT_NE(refusalsOf(needle.observe(waypoints)).find("they lie on one line"), std::string::npos);
}

TEST(Calibrate, RefusesAnAxisThatWasApproachedFromOneSideOnly) {
  std::vector<CalibrationWaypoint> waypoints;
  for (int row = 0; row < 5; ++row) {
    for (int i = 0; i < 5; ++i) {
      const Eigen::Vector3d point(20e-6 * i, 0, 20e-6 * row);
      waypoints.push_back({point - Eigen::Vector3d(30e-6, 0, 0), false, false});
      waypoints.push_back({point, true, false});
    }
  }
  SimulatedNeedle needle(drawnNeedle(1), waypoints.front().position);
  const std::string refusals = refusalsOf(needle.observe(waypoints));
  EXPECT_NE(refusals.find("axis x: points approached upwards / downwards = 0: must be at least 3 of each"),
            std::string::npos)
      << refusals;
}

TEST(Calibrate, RefusesWhatIsNotFinite) {
  const std::vector<TipObservation> good = observationsOf(drawnNeedle(1), true);
  std::vector<TipObservation> bad = good;
  bad[5].pixel->x() = kNan;
  bad[6].position.y() = kNan;
  bad[9].covariance.setZero();
  bad[1].focus = kNan;
  EXPECT_EQ(refusalsOf(bad),
            "observation 1: focus: must be finite\nobservation 5: pixel: must be finite\n"
            "observation 6: position: must be finite\n"
            "observation 9: covariance: must be finite, symmetric and positive definite\n");
}

TEST(Calibrate, RefusesALargeResidual) {
  SimulatedNeedleConfig truth = drawnNeedle(1);
  truth.noise = 1.5;
  EXPECT_NE(refusalsOf(observationsOf(truth)).find("residual = 1."), std::string::npos);
}

TEST(Calibrate, RefusesAScaleOutsideOfTheConfiguredRange) {
  CalibrationLimits limits;
  limits.pixel_size = {0.3e-6, 0.5e-6};
  EXPECT_NE(refusalsOf(observationsOf(drawnNeedle(1)), limits).find("m: must be in [3e-07, 5e-07] m"),
            std::string::npos);
}

TEST(Calibrate, RefusesAWideInterval) {
  CalibrationLimits limits;
  limits.angle_interval = 1e-5;
  EXPECT_NE(refusalsOf(observationsOf(drawnNeedle(1)), limits).find("95 % interval of angle: +- = "),
            std::string::npos);
}

TEST(Calibrate, RefusesABacklashAboveTheLimit) {
  SimulatedNeedleConfig truth = drawnNeedle(1);
  truth.value[kBacklashZ] = 5.5e-6;
  truth.noise = 0;
  EXPECT_EQ(refusalsOf(observationsOf(truth)), "backlash_z = 5.5e-06 m: must be in [0, 5e-06] m\n");
}

TEST(Calibrate, RefusesTooManyOutliers) {
  std::vector<TipObservation> observations = observationsOf(drawnNeedle(1));
  int number = 0;
  for (TipObservation& each : observations) {
    if (each.pixel && ++number % 4 == 0) *each.pixel += Eigen::Vector2d(number % 8 == 0 ? 40 : -30, 7 * number % 50);
  }
  EXPECT_NE(refusalsOf(observations).find("share of outliers = 0.25"), std::string::npos);
}

TEST(Calibrate, RefusesPixelsThatDoNotFollowTheMoves) {
  std::vector<TipObservation> observations = observationsOf(drawnNeedle(1));
  SimulatedNeedle random(drawnNeedle(2), Eigen::Vector3d::Zero());
  for (TipObservation& each : observations) {
    if (each.pixel) *each.pixel = Eigen::Vector2d(1392 * random.uniform(), 1040 * random.uniform());
  }
  EXPECT_NE(refusalsOf(observations), "");
  for (TipObservation& each : observations) {
    if (each.pixel) *each.pixel = Eigen::Vector2d(500, 400);  // the detector holds on to dust
  }
  EXPECT_NE(refusalsOf(observations), "");
}

TEST(Calibrate, AnAbsentBacklashIsGood) {
  for (int seed = 1; seed <= 50; ++seed) {
    SimulatedNeedleConfig truth = drawnNeedle(seed);
    truth.value.segment<3>(kBacklashX).setZero();
    const CalibrationOutcome outcome = calibrate(observationsOf(truth), {}, testSetup());
    // An interval of 95 % on an absent backlash lies below 0 in one trial of forty.
    if (!outcome.calibration) continue;
    EXPECT_NEAR(outcome.calibration->value[kBacklashX], 0, 0.1e-6);
  }
}

}  // namespace
}  // namespace microinjection
