#include "operation/teleoperation/device_axes_calibration.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

class DeviceAxesCalibrationTest : public ::testing::Test {
 protected:
  /// Moves the hand (m, the device's axes) and tells so. Returns the refusal.
  std::string move(double x, double y, double z) {
    hand += Eigen::Vector3d(x, y, z);
    return calibration.motion(hand);
  }
  void run() {
    ASSERT_EQ(calibration.begin(hand), "");
    ASSERT_EQ(move(0.03, 0, 0), "");
    ASSERT_EQ(move(0, 0, -0.03), "");
    ASSERT_EQ(move(0, 0.03, 0), "");
  }

  DeviceAxesCalibration calibration{"x y z", false};
  Eigen::Vector3d hand{0.1, -0.2, 0.05};
};

TEST_F(DeviceAxesCalibrationTest, EachMotionStartsWhereTheLastEnded) {
  EXPECT_NE(calibration.motion(hand), "") << "before it has begun";
  run();
  EXPECT_FALSE(calibration.running());
  EXPECT_EQ(calibration.axes(), "x -z y");
  EXPECT_EQ(calibration.changes(), 1);
  EXPECT_NEAR(calibration.fit().angleToAxis(), 0, 1e-12);
}

TEST_F(DeviceAxesCalibrationTest, ADeviceThatSpringsBackStartsFromItsRest) {
  calibration = DeviceAxesCalibration("x y z", true);
  calibration.begin(hand);
  EXPECT_EQ(calibration.motion(hand + Eigen::Vector3d(0, 0.015, 0)), "");
  EXPECT_EQ(calibration.motion(hand + Eigen::Vector3d(0, 0, 0.015)), "");
  EXPECT_EQ(calibration.motion(hand + Eigen::Vector3d(0.015, 0, 0)), "");
  EXPECT_EQ(calibration.axes(), "y z x");
}

TEST_F(DeviceAxesCalibrationTest, ARefusedMotionIsRepeatedFromWhereTheHandIs) {
  calibration.begin(hand);
  EXPECT_NE(move(0.02, 0.02, 0), "");
  EXPECT_TRUE(calibration.running());
  EXPECT_EQ(move(0.02, 0, 0), "");
  EXPECT_EQ(calibration.fit().next(), "away");
}

TEST_F(DeviceAxesCalibrationTest, WithoutAHandNothingChanges) {
  EXPECT_NE(calibration.begin({}), "");
  EXPECT_FALSE(calibration.running());
  calibration.begin(hand);
  EXPECT_EQ(calibration.motion({}), "no valid hand position");
  EXPECT_EQ(calibration.fit().motions(), 0);
  move(0.02, 0, 0);
  EXPECT_NE(calibration.undo({}), "");
  EXPECT_EQ(calibration.fit().motions(), 1);
}

TEST_F(DeviceAxesCalibrationTest, UndoTakesBackMotionThenTheRun) {
  calibration.begin(hand);
  move(0.02, 0, 0);
  hand += Eigen::Vector3d(0.01, 0.02, -0.03);
  EXPECT_EQ(calibration.undo(hand), "");
  EXPECT_EQ(calibration.fit().next(), "right");
  EXPECT_EQ(move(0, 0.02, 0), "") << "from where the hand was at the undo";
  calibration.undo(hand);
  EXPECT_EQ(calibration.undo(hand), "");
  EXPECT_FALSE(calibration.running());
  EXPECT_EQ(calibration.axes(), "x y z");
  EXPECT_EQ(calibration.changes(), 0);
}

TEST_F(DeviceAxesCalibrationTest, UndoTakesBackEachChange) {
  EXPECT_NE(calibration.undo(hand), "") << "there was none";
  run();
  calibration.begin(hand);
  move(0, 0.02, 0);
  move(0, 0, 0.02);
  move(0.02, 0, 0);
  EXPECT_EQ(calibration.axes(), "y z x");
  EXPECT_EQ(calibration.undo({}), "") << "it needs no hand";
  EXPECT_EQ(calibration.axes(), "x -z y");
  calibration.undo({});
  EXPECT_EQ(calibration.axes(), "x y z");
  EXPECT_EQ(calibration.changes(), 4);
  EXPECT_NE(calibration.undo({}), "");
}

TEST_F(DeviceAxesCalibrationTest, StopAndBeginLeaveTheAxes) {
  calibration.begin(hand);
  move(0.02, 0, 0);
  calibration.stop();
  EXPECT_FALSE(calibration.running());
  EXPECT_NE(move(0, 0, -0.02), "");
  calibration.begin(hand);
  EXPECT_EQ(calibration.fit().motions(), 0);
  EXPECT_EQ(calibration.axes(), "x y z");
}

TEST_F(DeviceAxesCalibrationTest, SaysWhatComesNext) {
  calibration.begin(hand);
  EXPECT_NE(calibration.prompt().find("to the right"), std::string::npos);
  move(0.02, 0, 0);
  EXPECT_NE(calibration.prompt().find("away"), std::string::npos);
  calibration.stop();
  EXPECT_EQ(calibration.prompt(), "device_axes: x y z");
}

}  // namespace
}  // namespace microinjection
