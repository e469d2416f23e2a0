#include "vision/calibration/calibration_run.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "benchmark/common/simulated_needle.h"
#include "vision/calibration/calibrate.h"

namespace microinjection {
namespace {

constexpr double kRunStep = 0.02;          // s
constexpr double kImagePeriod = 1 / 30.0;  // s
constexpr int kBlind = 10000;              // steps of a run that waits for a tip at each waypoint

/// A rig whose needle moves at the pattern's speed, and a camera.
class Rig {
 public:
  Rig(const SimulatedNeedleConfig& config, const Eigen::Vector3d& start)
      : needle_(config, start), position_(start), goal_(start) {}

  CalibrationInput input() const {
    return {now_, known_ ? std::optional(position_) : std::nullopt, position_ != goal_, tip_};
  }
  void command(const Eigen::Vector3d& goal) { goal_ = goal; }
  void step() {
    now_ += kRunStep;
    const Eigen::Vector3d way = goal_ - position_;
    const double reach = stuck_ ? 0 : 100e-6 * kRunStep;
    position_ = way.norm() <= reach ? goal_ : Eigen::Vector3d(position_ + reach * way.normalized());
    if (position_ == goal_ && moved_to_ != goal_) {
      needle_.moveTo(goal_);
      moved_to_ = goal_;
    }
    if (now_ - exposed_ < kImagePeriod) return;
    exposed_ = now_;
    if (blind_) {
      tip_.reset();
    } else {
      tip_ = SeenTip{now_ - late_, needle_.seenPixel(), 0.04 * Eigen::Matrix2d::Identity()};
    }
  }

  bool stuck_ = false, blind_ = false, known_ = true;
  double late_ = 0;  ///< s, age of an image

 private:
  SimulatedNeedle needle_;
  Eigen::Vector3d position_, goal_, moved_to_ = Eigen::Vector3d::Constant(1);
  std::optional<SeenTip> tip_;
  double now_ = 0, exposed_ = -1;
};

class CalibrationRunTest : public testing::Test {
 protected:
  CalibrationRunTest() : rig_(drawnNeedle(4), start_), run_(config_.pattern, plan()) {}

  CalibrationPlan plan() const {
    const Eigen::Vector3d far = Eigen::Vector3d::Constant(1);
    return planCalibration(config_.pattern, {0, 0, 100e-6}, start_, {-far, far});
  }
  void run(int steps = 5000) {
    for (int i = 0; i < steps && !run_.done() && run_.failure().empty(); ++i) {
      if (const auto goal = run_.step(rig_.input())) rig_.command(*goal);
      rig_.step();
    }
  }

  CalibrationConfig config_;
  Eigen::Vector3d start_{0, 0, 60e-6};
  Rig rig_;
  CalibrationRun run_;
};

TEST_F(CalibrationRunTest, GivesTheFitWhatItNeeds) {
  run();
  ASSERT_TRUE(run_.done()) << run_.failure();
  EXPECT_EQ(run_.seen(), 60);
  EXPECT_EQ(run_.observations().size(), run_.waypoints());
  const CalibrationOutcome outcome = calibrate(run_.observations(), config_.limits, {"2026-01-01T00:00:00Z", {}, {}});
  ASSERT_TRUE(outcome.calibration) << outcome.refusals.front();
  const SimulatedNeedleConfig truth = drawnNeedle(4);
  const double scale = truth.value[kPixelSize];
  EXPECT_NEAR(outcome.calibration->value[kPixelSize], scale, 1e-3 * scale);
  EXPECT_NEAR(outcome.calibration->value[kBacklashX], 2e-6, 0.2e-6);
  EXPECT_EQ(outcome.calibration->mirrored, truth.mirrored);
}

TEST_F(CalibrationRunTest, TakesNoImageOfBeforeTheNeedleRests) {
  rig_.late_ = 10;  // s: every image is of an earlier place
  run(kBlind);
  EXPECT_EQ(run_.seen(), 0);
}

TEST_F(CalibrationRunTest, ALateImageIsWaitedFor) {
  rig_.late_ = 2 * config_.pattern.observation_time;
  run();
  ASSERT_TRUE(run_.done());
  EXPECT_EQ(run_.seen(), 60);
}

TEST_F(CalibrationRunTest, EndsWhenTheCameraStops) {
  for (int i = 0; i < kBlind && run_.seen() < 12; ++i) run(1);
  ASSERT_EQ(run_.seen(), 12);
  rig_.blind_ = true;
  run(kBlind);
  EXPECT_FALSE(run_.done());
  EXPECT_EQ(run_.seen(), 12);
  EXPECT_NE(run_.failure().find("not seen at 10 points in a row"), std::string::npos) << run_.failure();
}

TEST_F(CalibrationRunTest, FailsWhenAMoveDoesNotArrive) {
  run(600);
  rig_.stuck_ = true;
  run();
  EXPECT_FALSE(run_.done());
  EXPECT_NE(run_.failure().find("was not reached"), std::string::npos) << run_.failure();
}

TEST_F(CalibrationRunTest, FailsAtOnceWhenThePositionIsLost) {
  for (const int steps : {300, 305, 310, 315, 320}) {  // in all phases of a waypoint
    CalibrationRun run(config_.pattern, plan());
    Rig rig(drawnNeedle(4), start_);
    for (int i = 0; i < steps; ++i) {
      if (const auto goal = run.step(rig.input())) rig.command(*goal);
      rig.step();
    }
    rig.known_ = false;
    EXPECT_FALSE(run.step(rig.input()));
    EXPECT_NE(run.failure().find("position"), std::string::npos);
  }
}

TEST_F(CalibrationRunTest, FailsWhenTheNeedleLeavesAWaypoint) {
  run(300);
  const std::size_t waypoint = run_.waypoint();
  while (run_.waypoint() == waypoint) run(1);
  do {
    run(1);
  } while (rig_.input().busy);
  run(2);  // it settles at the next one
  rig_.command(start_);
  run(3);
  EXPECT_NE(run_.failure().find("by itself"), std::string::npos) << run_.failure();
}

TEST_F(CalibrationRunTest, TakesNoImageOfTheFuture) {
  rig_.late_ = -10;
  run(kBlind);
  EXPECT_EQ(run_.seen(), 0);
}

}  // namespace
}  // namespace microinjection
