#include "rig/devices/origin_watch.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

const Eigen::Vector3d kCount(1e-6, 1e-6, 2e-6);  // m
const Eigen::Vector3d kHere(10, 20, 30), kThere(-10, 40, 30), kZero(0, 0, 0);

TEST(OriginWatch, BelievesAnyPlaceBeforeItKnowsOne) {
  OriginWatch watch;
  watch.goesTo(kThere);
  EXPECT_EQ(watch.outside(kHere, kCount), 0);
  EXPECT_TRUE(watch.mayStandAt(kZero, kCount, 0));
  EXPECT_TRUE(watch.remainsAt(kZero, kCount, 0));
}

TEST(OriginWatch, MeasuresFromThePlaceAtRestInMetres) {
  OriginWatch watch;
  watch.stands(kHere);
  EXPECT_EQ(watch.outside(kHere, kCount), 0);
  EXPECT_DOUBLE_EQ(watch.outside(kHere + Eigen::Vector3d(3, 0, 2), kCount), 5e-6);
  watch.clear();
  EXPECT_EQ(watch.outside(kThere, kCount), 0);
}

TEST(OriginWatch, AMoveMakesABoxThatLastsUntilItStands) {
  OriginWatch watch;
  watch.stands(kHere);
  watch.goesTo(kThere);
  for (const Eigen::Vector3d& inside : {kHere, kThere, Eigen::Vector3d(0, 30, 30), Eigen::Vector3d(10, 40, 30)}) {
    EXPECT_EQ(watch.outside(inside, kCount), 0);
  }
  EXPECT_DOUBLE_EQ(watch.outside({11, 30, 30}, kCount), 1e-6);
  EXPECT_DOUBLE_EQ(watch.outside({0, 19, 30}, kCount), 1e-6);
  EXPECT_DOUBLE_EQ(watch.outside({0, 30, 29}, kCount), 2e-6);
  watch.stands(kThere);
  EXPECT_DOUBLE_EQ(watch.outside({0, 40, 30}, kCount), 10e-6);
}

TEST(OriginWatch, AMoveThatWasNotConfirmedMayNotHaveBegun) {
  OriginWatch watch;
  watch.stands(kZero);
  watch.goesTo(kThere);
  EXPECT_TRUE(watch.mayStandAt(kZero, kCount, 1e-6));
  EXPECT_TRUE(watch.mayStandAt(kThere, kCount, 1e-6));
  EXPECT_FALSE(watch.mayStandAt(kHere, kCount, 1e-6));
  watch.hasDeparted();
  EXPECT_FALSE(watch.mayStandAt(kZero, kCount, 1e-6));
  EXPECT_TRUE(watch.mayStandAt(kThere, kCount, 1e-6));
  EXPECT_FALSE(watch.remainsAt(kThere, kCount, 1e-6));
  watch.stands(kThere);
  EXPECT_TRUE(watch.remainsAt(kThere, kCount, 1e-6));
}

}  // namespace
}  // namespace microinjection
