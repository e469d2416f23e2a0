#include "hardware/devices/origin_monitor.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

const Eigen::Vector3d kCount(1e-6, 1e-6, 2e-6);  // m
const Eigen::Vector3d kHere(10, 20, 30), kThere(-10, 40, 30), kZero(0, 0, 0);

TEST(OriginMonitor, BelievesAnyPlaceBeforeItKnowsOne) {
  OriginMonitor monitor;
  monitor.setMove(kThere);
  EXPECT_EQ(monitor.outside(kHere, kCount), 0);
  EXPECT_TRUE(monitor.mayStandAt(kZero, kCount, 0));
  EXPECT_TRUE(monitor.remainsAt(kZero, kCount, 0));
}

TEST(OriginMonitor, MeasuresFromThePlaceAtRestInMetres) {
  OriginMonitor monitor;
  monitor.setAtRest(kHere);
  EXPECT_EQ(monitor.outside(kHere, kCount), 0);
  EXPECT_DOUBLE_EQ(monitor.outside(kHere + Eigen::Vector3d(3, 0, 2), kCount), 5e-6);
  monitor.clear();
  EXPECT_EQ(monitor.outside(kThere, kCount), 0);
}

TEST(OriginMonitor, AMoveMakesABoxThatLastsUntilItStands) {
  OriginMonitor monitor;
  monitor.setAtRest(kHere);
  monitor.setMove(kThere);
  for (const Eigen::Vector3d& inside : {kHere, kThere, Eigen::Vector3d(0, 30, 30), Eigen::Vector3d(10, 40, 30)}) {
    EXPECT_EQ(monitor.outside(inside, kCount), 0);
  }
  EXPECT_DOUBLE_EQ(monitor.outside({11, 30, 30}, kCount), 1e-6);
  EXPECT_DOUBLE_EQ(monitor.outside({0, 19, 30}, kCount), 1e-6);
  EXPECT_DOUBLE_EQ(monitor.outside({0, 30, 29}, kCount), 2e-6);
  monitor.setAtRest(kThere);
  EXPECT_DOUBLE_EQ(monitor.outside({0, 40, 30}, kCount), 10e-6);
}

TEST(OriginMonitor, AMoveThatWasNotConfirmedMayNotHaveBegun) {
  OriginMonitor monitor;
  monitor.setAtRest(kZero);
  monitor.setMove(kThere);
  EXPECT_TRUE(monitor.mayStandAt(kZero, kCount, 1e-6));
  EXPECT_TRUE(monitor.mayStandAt(kThere, kCount, 1e-6));
  EXPECT_FALSE(monitor.mayStandAt(kHere, kCount, 1e-6));
  monitor.confirmMove();
  EXPECT_FALSE(monitor.mayStandAt(kZero, kCount, 1e-6));
  EXPECT_TRUE(monitor.mayStandAt(kThere, kCount, 1e-6));
  EXPECT_FALSE(monitor.remainsAt(kThere, kCount, 1e-6));
  monitor.setAtRest(kThere);
  EXPECT_TRUE(monitor.remainsAt(kThere, kCount, 1e-6));
}

}  // namespace
}  // namespace microinjection
