#include "vision/calibration/image_target.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>

#include "vision/calibration/calibration_trial.h"

namespace microinjection {
namespace {

const Eigen::Vector2d kGoalPixel(900, 300);  // px

class ImageTargetTest : public ::testing::Test {
 protected:
  ImageTargetTest() : truth(drawnNeedle(21)), needle(needleOf(truth)) {
    calibration = *calibrateNeedle(needle).calibration;
    play = std::make_unique<Play>(calibration.backlash(), testWaypoints().front().position);
    for (const CalibrationWaypoint& each : testWaypoints()) play->moveTo(each.position);
  }
  TipFrame frame(std::uint64_t sequence, double stamp) { return {sequence, stamp, needle.truePixel()}; }
  ImageStep step(const TipFrame& each, double now, double rested = 0) {
    return target.step(each, kGoalPixel, calibration, *play, now, rested);
  }
  void follow(const ImageStep& step) {
    needle.moveTo(*step.position);
    play->moveTo(*step.position);
  }

  SimulatedNeedleConfig truth;
  SimulatedNeedle needle;
  CameraCalibration calibration;
  std::unique_ptr<Play> play;
  ImageTarget target{ImageTargetConfig()};
};

TEST_F(ImageTargetTest, BringsTheTipToTheTargetInStepsThatAreNotTooLong) {
  double time = 1;
  for (int i = 1; i < 60; ++i, time += 0.1) {
    const Eigen::Vector3d before = needle.place();
    const ImageStep step = this->step(frame(i, time), time + 0.03, time - 0.01);
    if (step.arrived) {
      EXPECT_LT((needle.truePixel() - kGoalPixel).norm(), 0.7);
      EXPECT_GT(i, 5);
      return;
    }
    ASSERT_TRUE(step.position) << step.reason;
    follow(step);
    EXPECT_LT((needle.place() - before).norm(), 5e-6 * 1.02);
  }
  FAIL() << "not arrived: " << (needle.truePixel() - kGoalPixel).norm() << " px";
}

TEST_F(ImageTargetTest, ANearTargetIsApproachedByTheGain) {
  const Eigen::Vector2d goal = needle.truePixel() + Eigen::Vector2d(10, 0);
  const ImageStep step = target.step(frame(1, 1), goal, calibration, *play, 1.01, 0);
  follow(step);
  EXPECT_NEAR((needle.truePixel() - goal).norm(), 5, 0.2);
}

TEST_F(ImageTargetTest, ArrivesThoughTheCalibrationIsTurned) {
  calibration.value[kAngle] += 0.5;
  ImageTargetConfig config;
  config.largest_jump = 1e-3;
  target = ImageTarget(config);
  double time = 1;
  for (int i = 1; i < 200; ++i, time += 0.1) {
    const ImageStep step = this->step(frame(i, time), time + 0.03);
    if (step.arrived) return;
    ASSERT_TRUE(step.position) << step.reason;
    follow(step);
  }
  FAIL();
}

TEST_F(ImageTargetTest, NoMotionOnAStaleImage) {
  const ImageStep step = this->step(frame(1, 1), 3);
  EXPECT_FALSE(step.position);
  EXPECT_EQ(step.reason, "the image is stale: age 2 s, allowed up to 0.2 s");
}

TEST_F(ImageTargetTest, NoMotionOnAFrameThatIsNotNewer) {
  EXPECT_TRUE(step(frame(7, 1.0), 1.05).position);
  EXPECT_EQ(step(frame(7, 1.1), 1.15).reason, "image 7 is not newer than image 7");
  EXPECT_EQ(step(frame(6, 1.1), 1.15).reason, "image 6 is not newer than image 7");
  EXPECT_EQ(step(frame(8, 0.9), 1.05).reason, "image 8 is out of order: exposed at 0.9 s, the one before at 1 s");
  EXPECT_TRUE(step(frame(8, 1.1), 1.15).position);
  target.reset();
  EXPECT_TRUE(step(frame(1, 1.2), 1.25).position);
}

TEST_F(ImageTargetTest, ARefusedFrameDoesNotBlockTheNextOne) {
  EXPECT_FALSE(step(frame(100, 5.0), 1.05).position);  // of the future
  EXPECT_TRUE(step(frame(8, 1.0), 1.05).position);
}

TEST_F(ImageTargetTest, NoMotionOnAnImageFromBeforeTheLastStep) {
  EXPECT_EQ(step(frame(1, 1.0), 1.05, 1.02).reason, "the image was exposed 0.02 s before the needle came to rest");
}

TEST_F(ImageTargetTest, NoMotionOnAnImageOfTheFuture) {
  EXPECT_EQ(step(frame(1, 2.0), 1.5).reason, "the image is of the future: exposed 0.5 s from now");
}

TEST_F(ImageTargetTest, NoMotionWhenTheTipIsSeenElsewhere) {
  TipFrame far = frame(1, 1);
  far.tip += Eigen::Vector2d(600, 0);
  const ImageStep step = this->step(far, 1.01);
  EXPECT_FALSE(step.position);
  EXPECT_NE(step.reason.find("um from where it is expected, allowed up to 40 um"), std::string::npos) << step.reason;
}

TEST_F(ImageTargetTest, NoMotionOnWhatIsNotFiniteOrUnknown) {
  TipFrame bad = frame(1, 1);
  bad.tip.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(step(bad, 1.01).reason, "the tip's pixel is not finite");
  EXPECT_EQ(step(frame(1, std::numeric_limits<double>::quiet_NaN()), 1.01).reason, "a time is not finite");
  *play = Play(calibration.backlash(), Eigen::Vector3d::Zero());
  EXPECT_EQ(step(frame(1, 1), 1.01).reason, "axis x: its play is not known, move it by more than its backlash first");
}

}  // namespace
}  // namespace microinjection
