#include "cell/surrogate/work_limit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

/// A spring along z from 0, whose stiffness changes while it is pressed.
struct Spring {
  WorkLimit limit;
  double stiffness = 0.1;  // N/m
  Eigen::Vector3d step(double z) { return limit.step({0, 0, -stiffness * z}, {0, 0, z}, 0.5 * stiffness * z * z); }
  void press(double from, double to) {
    for (int i = 0; i <= 1000; ++i) step(from + (to - from) * i / 1000);
  }
};

constexpr double kDepth = -5e-6;

TEST(WorkLimit, DoesNothingUntilTheCellChanges) {
  Spring spring;
  spring.press(0, kDepth);
  spring.stiffness *= 50;
  EXPECT_DOUBLE_EQ(spring.step(kDepth).z(), -spring.stiffness * kDepth);
}

TEST(WorkLimit, AStifferCellIsFeltInFullAndReturnsWhatWasPutIn) {
  Spring spring;
  spring.press(0, kDepth);
  const double put_in = spring.limit.work();
  EXPECT_NEAR(put_in, 0.5 * 0.1 * kDepth * kDepth, 1e-3 * put_in);
  spring.stiffness *= 3;
  spring.limit.activate();
  EXPECT_DOUBLE_EQ(spring.step(kDepth).z(), -spring.stiffness * kDepth);
  spring.press(kDepth, 0);
  EXPECT_GE(spring.limit.work(), -1e-9 * put_in);
  EXPECT_LT(spring.limit.work(), 0.05 * put_in) << "nearly all of it came back";
}

TEST(WorkLimit, OfAMuchStifferCellAPartIsFelt) {
  Spring spring;
  spring.press(0, kDepth);
  spring.stiffness *= 40;
  spring.limit.activate();
  EXPECT_NEAR(spring.step(kDepth).z(), -0.1 * spring.stiffness * kDepth, 0.01 * -0.1 * spring.stiffness * kDepth);
}

TEST(WorkLimit, WithoutWorkPutInNoneComesBack) {
  Spring spring;
  spring.limit.activate();
  spring.step(kDepth);
  EXPECT_EQ(spring.step(0.9 * kDepth), Eigen::Vector3d::Zero());
}

TEST(WorkLimit, AContactThatBeginsWhileItAppliesIsFelt) {
  Spring spring;
  spring.limit.activate();
  spring.press(0, kDepth);
  EXPECT_NEAR(spring.step(kDepth).z(), -spring.stiffness * kDepth, 1e-6 * -spring.stiffness * kDepth);
  spring.press(kDepth, 0);
  EXPECT_GE(spring.limit.work(), 0);
}

TEST(WorkLimit, AForceThatWasLostComesBackUnderAPressingNeedle) {
  Spring spring;
  spring.limit.activate();
  spring.press(0.5 * kDepth, 0.5 * kDepth);
  spring.press(0.5 * kDepth, 0.1 * kDepth);
  EXPECT_NEAR(spring.limit.work(), 0, 1e-4 * 0.5 * spring.stiffness * 0.25 * kDepth * kDepth);
  spring.press(0.5 * kDepth, 2 * kDepth);
  EXPECT_NEAR(spring.step(2 * kDepth).z(), -2 * spring.stiffness * kDepth, 0.02 * -2 * spring.stiffness * kDepth);
}

}  // namespace
}  // namespace microinjection
