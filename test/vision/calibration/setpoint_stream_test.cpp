#include "vision/calibration/setpoint_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

namespace microinjection {
namespace {

constexpr double kPeriod = 0.02, kReach = 1e-6, kArrived = 0.1e-6;  // s, m, m
const Eigen::Vector3d kStart(0, 0, 60e-6), kGoal(20e-6, 0, 50e-6);

/// A controller that counts set-points from where the needle is after each hold.
struct Controller {
  Eigen::Vector3d needle = kStart, offset = Eigen::Vector3d::Zero();
  bool held = false;
  double largest = 0;  ///< m, motion in one step

  void follow(const Eigen::Vector3d& setpoint, bool late) {
    if (late) {
      held = true;
      return;
    }
    if (std::exchange(held, false)) offset = needle - setpoint;
    largest = std::max(largest, (setpoint + offset - needle).norm());
    needle = setpoint + offset;
  }
};

/// Steps until the needle has arrived; set-points of [from, until) are late.
int stepsTo(SetpointStream& stream, Controller& controller, int from, int until) {
  for (int step = 0; step < 2000; ++step) {
    controller.follow(stream.advance(kGoal, kReach), step >= from && step < until);
    if (stream.arrived(controller.needle, step * kPeriod)) return step;
  }
  return -1;
}

TEST(SetpointStream, BringsTheNeedleToItsGoal) {
  SetpointStream stream(kStart, kArrived, 0);
  Controller controller;
  EXPECT_GT(stepsTo(stream, controller, 0, 0), 20);
  EXPECT_LE((controller.needle - kGoal).norm(), kArrived);
}

TEST(SetpointStream, AfterAHoldToo) {
  SetpointStream stream(kStart, kArrived, 0);
  Controller controller;
  EXPECT_GT(stepsTo(stream, controller, 5, 15), 0);
  EXPECT_LE((controller.needle - kGoal).norm(), kArrived);
  EXPECT_LE(controller.largest, 1.001 * kReach);  // the offset is taken up at the same speed
}

TEST(SetpointStream, ANeedleThatCannotMoveIsNotAskedForMoreAndMore) {
  SetpointStream stream(kStart, kArrived, 0);
  Eigen::Vector3d setpoint = kStart;
  for (int step = 0; step < 5000; ++step) {
    setpoint = stream.advance(kGoal, kReach);
    EXPECT_FALSE(stream.arrived(kStart, step * kPeriod));
  }
  EXPECT_TRUE(stream.waits());
  EXPECT_LE((setpoint - kGoal).norm(), 50e-6);
}

}  // namespace
}  // namespace microinjection
