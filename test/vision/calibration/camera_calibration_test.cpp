#include "vision/calibration/camera_calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "vision/calibration/calibration_trial.h"

namespace microinjection {
namespace {

/// A calibrated needle and the play that the calibration gives it.
struct Session {
  explicit Session(int seed, double outlier_share = 0, bool focus = false) : truth(drawnNeedle(seed)) {
    truth.outlier_share = outlier_share;
    needle = std::make_unique<SimulatedNeedle>(needleOf(truth));
    calibration = calibrateNeedle(*needle, focus).calibration;
    const auto waypoints = testWaypoints(focus);
    play = std::make_unique<Play>(calibration->backlash(), waypoints.front().position);
    for (const CalibrationWaypoint& each : waypoints) play->moveTo(each.position);
  }
  void moveTo(const Eigen::Vector3d& position) {
    needle->moveTo(position);
    play->moveTo(position);
  }

  SimulatedNeedleConfig truth;
  std::unique_ptr<SimulatedNeedle> needle;
  std::optional<CameraCalibration> calibration;
  std::unique_ptr<Play> play;
};

TEST(CameraCalibration, PixelAndPlaceAreInverse) {
  const Session session(1);
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), Eigen::Vector2d(1391, 1039), Eigen::Vector2d(3, 900)}) {
    const Eigen::Vector3d place = session.calibration->placeFor(pixel, 7e-6);
    EXPECT_EQ(place.y(), 7e-6);
    EXPECT_NEAR((session.calibration->pixelOf(place) - pixel).norm(), 0, 1e-8);
  }
}

TEST(CameraCalibration, AMoveLandsWithin300NanometresAnywhereInTheField) {
  for (const double outliers : {0.0, 0.05}) {
    std::vector<double> errors;
    for (int seed = 1; seed <= 40; ++seed) {
      Session session(seed, outliers);
      for (int i = 0; i < 25; ++i) {
        const Eigen::Vector2d goal(1391 * session.needle->uniform(), 1039 * session.needle->uniform());
        for (const auto& position : session.calibration->commandFor(goal, *session.play)) session.moveTo(position);
        errors.push_back(session.truth.value[kPixelSize] * (session.needle->truePixel() - goal).norm());
      }
    }
    std::sort(errors.begin(), errors.end());
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.1e-6);  // a third of what is asked for
    EXPECT_LT(errors.back(), 0.3e-6);
  }
}

TEST(CameraCalibration, LandingFailsWithoutTheBacklash) {
  Session session(1);
  session.calibration->value.segment<3>(kBacklashX).setZero();
  double largest = 0;
  Play none(Eigen::Vector3d::Zero(), session.play->position());
  for (int i = 0; i < 25; ++i) {
    const Eigen::Vector2d goal(1391 * session.needle->uniform(), 1039 * session.needle->uniform());
    const Eigen::Vector3d position = session.calibration->commandFor(goal, none).back();
    none.moveTo(position);
    session.needle->moveTo(position);
    largest = std::max(largest, session.truth.value[kPixelSize] * (session.needle->truePixel() - goal).norm());
  }
  EXPECT_GT(largest, 1e-6);
}

TEST(CameraCalibration, PixelCovarianceIsTheScatterOfThePrediction) {
  const Eigen::Vector3d place(60e-6, 0, -45e-6);
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero(), stated = Eigen::Matrix2d::Zero();
  constexpr int kTrials = 1000;
  SimulatedNeedleConfig truth = drawnNeedle(77);
  truth.value[kDepthDriftX] = truth.value[kDepthDriftZ] = 0;  // the play of y would shift the tip from trial to trial
  const Eigen::Vector2d pixel = tipPixel<double>(truth.value, truth.mirrored, place - truth.origin);
  for (int i = 0; i < kTrials; ++i) {
    truth.seed = 500 + i;
    SimulatedNeedle needle = needleOf(truth);
    const CameraCalibration calibration = *calibrateNeedle(needle).calibration;
    const Eigen::Vector2d error = calibration.pixelOf(place) - pixel;
    scatter += error * error.transpose() / kTrials;
    stated += calibration.pixelCovariance(place) / kTrials;
  }
  EXPECT_LT((scatter - stated).norm(), 0.12 * stated.norm()) << scatter << '\n' << stated;
}

TEST(Rezero, KeepsTheAxesAndMovesTheTipOnly) {
  Session session(3, 0, true);
  session.truth.value.segment<2>(kTipU) += Eigen::Vector2d(123, -45);
  SimulatedNeedle needle(session.truth, Eigen::Vector3d(80e-6, 0, 80e-6));
  Play play(session.calibration->backlash(), Eigen::Vector3d(80e-6, 0, 80e-6));
  for (const double x : {70e-6, 30e-6}) {
    needle.moveTo(Eigen::Vector3d(x, 0, x - 10e-6));
    play.moveTo(Eigen::Vector3d(x, 0, x - 10e-6));
  }
  NewTip tip;
  tip.pixel = needle.seenPixel();
  const RezeroResult result = rezero(*session.calibration, tip, play, "2025-03-04T08:00:00Z");
  ASSERT_TRUE(result.calibration) << result.refusal;
  EXPECT_EQ(result.warning, "");
  EXPECT_EQ(result.calibration->axes(), session.calibration->axes());
  EXPECT_EQ(result.calibration->backlash(), session.calibration->backlash());
  EXPECT_EQ(result.calibration->tips.size(), 2u);
  EXPECT_FALSE(result.calibration->focusOf(play.tip()));
  EXPECT_TRUE(result.calibration->focusMotion());
  EXPECT_EQ(result.calibration->pixelOf(play.tip()), tip.pixel);
  needle.moveTo(Eigen::Vector3d(-20e-6, 0, -30e-6));
  play.moveTo(Eigen::Vector3d(-20e-6, 0, -30e-6));
  EXPECT_LT((result.calibration->pixelOf(play.tip()) - needle.truePixel()).norm(), 1);
}

TEST(Rezero, IntervalsOfTheNewTipCover) {
  int held = 0, all = 0;
  Session session(3);
  for (int i = 0; i < 2000; ++i) {
    NewTip tip;
    tip.pixel = session.needle->seenPixel();
    const CameraCalibration moved = *rezero(*session.calibration, tip, *session.play, kTestDate).calibration;
    for (const CalibrationParameter parameter : {kTipU, kTipV}) {
      held += moved.interval(parameter).contains(session.needle->truePixel()[parameter - kTipU]) ? 1 : 0;
      ++all;
    }
  }
  EXPECT_GT(held, 0.93 * all);
  EXPECT_LT(held, 0.97 * all);
}

TEST(Rezero, RefusesWithAReason) {
  const Session session(3);
  NewTip tip;
  const auto refusal = [&](const NewTip& what, const Play& play, const std::string& date = kTestDate) {
    const RezeroResult result = rezero(*session.calibration, what, play, date);
    EXPECT_FALSE(result.calibration);
    return result.refusal;
  };
  EXPECT_EQ(refusal(tip, Play(session.calibration->backlash(), Eigen::Vector3d::Zero())),
            "axis x: its play is not known, move it by more than its backlash first");
  EXPECT_EQ(refusal(tip, *session.play, "yesterday"), "date = yesterday: must be YYYY-MM-DDTHH:MM:SSZ");
  tip.pixel.x() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(tip, *session.play), "the new tip's pixel is not finite");
  tip = {};
  tip.covariance.setZero();
  EXPECT_EQ(refusal(tip, *session.play), "the new tip's covariance is not finite and positive definite");
}

TEST(TipHistory, SaysNothingBelowFourTips) {
  std::vector<TipRecord> history(3);
  EXPECT_FALSE(tipRegion(history));
  EXPECT_EQ(tipWarning({kTestDate, Eigen::Vector2d(1, 1)}, history), "");
}

TEST(TipHistory, WarnsWithNumbersAndIsNotMovedByOneBadTip) {
  std::vector<TipRecord> history;
  for (const double x : {-20e-6, -10e-6, 0.0, 10e-6, 20e-6, 5e-6}) history.push_back({kTestDate, {x, 2 * x}});
  history.push_back({kTestDate, {5e-3, 5e-3}});  // once a pipette was not pushed in
  EXPECT_EQ(tipWarning({kTestDate, Eigen::Vector2d(30e-6, 40e-6)}, history), "");
  const std::string warning = tipWarning({kTestDate, Eigen::Vector2d(300e-6, 40e-6)}, history);
  EXPECT_EQ(warning.find("tip x = 300 um: expected in ["), 0u) << warning;
  EXPECT_NE(warning.find("from 7 tips of this holder (median 5 um"), std::string::npos) << warning;
  EXPECT_EQ(warning.find("tip z"), std::string::npos);
}

TEST(TipHistory, FewGoodTipsLieOutside) {
  SimulatedNeedle random(drawnNeedle(9), Eigen::Vector3d::Zero());
  for (const int count : {4, 8, 20}) {
    int outside = 0;
    constexpr int kTrials = 4000;
    for (int i = 0; i < kTrials; ++i) {
      std::vector<TipRecord> history(count);
      for (TipRecord& each : history) each.place = 50e-6 * Eigen::Vector2d(random.normal(), random.normal());
      const TipRecord tip{kTestDate, 50e-6 * Eigen::Vector2d(random.normal(), random.normal())};
      outside += tipWarning(tip, history).empty() ? 0 : 1;
    }
    EXPECT_LT(outside, 0.08 * kTrials) << count;
    EXPECT_GT(outside, 0.01 * kTrials) << count;
  }
}

}  // namespace
}  // namespace microinjection
