#include "vision/calibration/drift_watch.h"

#include <gtest/gtest.h>

#include <limits>

#include "vision/calibration/calibration_trial.h"

namespace microinjection {
namespace {

class DriftWatchTest : public ::testing::Test {
 protected:
  DriftWatchTest() : truth(drawnNeedle(31)), needle(needleOf(truth)) {
    calibration = *calibrateNeedle(needle).calibration;
    drift_direction = Eigen::Vector2d(0.6, -0.8) / truth.value[kPixelSize];
  }
  /// Adds an observation with `drift` (m) and noise; an outlier of 60 px instead when told so.
  DriftReport add(double drift, bool outlier = false) {
    Eigen::Vector2d seen = calibration.pixelOf(place) + drift * drift_direction;
    seen += 0.2 * Eigen::Vector2d(needle.normal(), needle.normal());
    if (outlier) seen += Eigen::Vector2d(60, 30);
    return watch.add(calibration, place, seen, 0.04 * Eigen::Matrix2d::Identity());
  }

  SimulatedNeedleConfig truth;
  SimulatedNeedle needle;
  CameraCalibration calibration;
  Eigen::Vector2d drift_direction;  // px/m
  Eigen::Vector3d place{10e-6, 0, 20e-6};
  DriftWatch watch{DriftWatchConfig()};
};

TEST_F(DriftWatchTest, WaitsForItsWindow) {
  for (int i = 1; i < 20; ++i) EXPECT_EQ(add(0).verdict, DriftVerdict::kTooFew);
  EXPECT_EQ(add(0).verdict, DriftVerdict::kWithin);
}

TEST_F(DriftWatchTest, RaisesNoFalseAlarm) {
  for (const double drift : {0.0, 0.25e-6, 0.5e-6}) {
    watch.reset();
    int alarms = 0;
    for (int i = 0; i < 20000; ++i) alarms += add(drift).verdict == DriftVerdict::kDrifted ? 1 : 0;
    // At the threshold itself the one-sided rate is 5e-5 an observation, and neighbours share their window.
    EXPECT_LE(alarms, drift < 0.5e-6 ? 0 : 40) << drift;
  }
}

TEST_F(DriftWatchTest, FindsADriftWithinItsWindow) {
  for (int i = 0; i < 50; ++i) add(0);
  int count = 0;
  while (add(0.8e-6).verdict != DriftVerdict::kDrifted && count < 100) ++count;
  EXPECT_LT(count, 20);
  EXPECT_GT(count, 5);  // not on a few observations
  const DriftReport report = add(0.8e-6);
  EXPECT_NE(report.text.find("it drifted: allowed up to 0.5 um"), std::string::npos) << report.text;
}

TEST_F(DriftWatchTest, MeasuresTheDrift) {
  DriftReport report;
  for (int i = 0; i < 20; ++i) report = add(2e-6);
  EXPECT_NEAR(report.distance, 2e-6, 0.02e-6);
  EXPECT_NEAR((report.drift - 2e-6 * drift_direction).norm(), 0, 0.3);
  EXPECT_LT(report.half_width, 0.1e-6);
}

TEST_F(DriftWatchTest, IsNotMovedByBadDetections) {
  for (int i = 0; i < 200; ++i) EXPECT_NE(add(0, i % 5 == 0).verdict, DriftVerdict::kDrifted);
}

TEST_F(DriftWatchTest, IsUnsureNearTheThreshold) {
  DriftReport report;
  for (int i = 0; i < 20; ++i) report = add(0.49e-6);
  EXPECT_EQ(report.verdict, DriftVerdict::kUnsure);
}

TEST_F(DriftWatchTest, AVagueCalibrationGivesNoAlarm) {
  calibration.covariance *= 1e4;
  DriftReport report;
  for (int i = 0; i < 20; ++i) report = add(1e-6);
  EXPECT_EQ(report.verdict, DriftVerdict::kUnsure);
}

TEST_F(DriftWatchTest, IgnoresWhatIsNotFinite) {
  for (int i = 0; i < 20; ++i) add(0);
  const Eigen::Vector2d bad(std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_EQ(watch.add(calibration, place, bad, Eigen::Matrix2d::Identity()).verdict, DriftVerdict::kTooFew);
  EXPECT_EQ(add(0).verdict, DriftVerdict::kWithin);
}

}  // namespace
}  // namespace microinjection
