#include "operation/teleoperation/force_limiter.h"

#include <gtest/gtest.h>

#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kZero = Eigen::Vector3d::Zero();

TEST(ForceLimiter, LimitsTheSizeAndKeepsTheDirection) {
  ForceLimiter limiter{{3, 1e9}};
  const Eigen::Vector3d force = limiter.step({6, 0, 8}, kZero, kStep);
  EXPECT_LT((force - Eigen::Vector3d(1.8, 0, 2.4)).norm(), 1e-12);
}

TEST(ForceLimiter, LimitsTheRateUpAndDown) {
  ForceLimiter limiter{{3, 100}};
  EXPECT_NEAR(limiter.step({0, 0, 1}, kZero, kStep).z(), 0.1, 1e-12);
  for (int i = 0; i < 20; ++i) limiter.step({0, 0, 1}, kZero, kStep);
  EXPECT_EQ(limiter.step({0, 0, 1}, kZero, kStep).z(), 1) << "at rest to the last bit";
  EXPECT_NEAR(limiter.step(kZero, kZero, kStep).z(), 0.9, 1e-12);
}

TEST(ForceLimiter, ALingeringForceMayResistButNotPush) {
  const auto punctured = [](double speed) {
    ForceLimiter limiter{{3, 100}};
    for (int i = 0; i < 20; ++i) limiter.step({0, 0, 1}, kZero, kStep);
    return limiter.step(kZero, {0, 0, speed}, kStep).z();
  };
  EXPECT_NEAR(punctured(-0.05), 0.9, 1e-12) << "the hand goes on in: a soft fall";
  EXPECT_EQ(punctured(0.05), 0) << "the hand goes out: no push";
  EXPECT_NEAR(punctured(0.0005), 0.9, 1e-12) << "at rest there is no direction";
}

TEST(ForceLimiter, WantedPushIsKept) {
  ForceLimiter limiter{{3, 100}};
  for (int i = 0; i < 20; ++i) limiter.step({0.3, 0, 1}, kZero, kStep);
  const Eigen::Vector3d force = limiter.step({0.3, 0, 0.5}, {0, 0, 0.05}, kStep);
  EXPECT_NEAR(force.z(), 0.5, 1e-12) << "down to what is wanted, not to zero";
  EXPECT_NEAR(force.x(), 0.3, 1e-12) << "across the motion nothing is let go";
}

TEST(ForceLimiter, ReleasesAtOnce) {
  ForceLimiter limiter{{3, 100}};
  for (int i = 0; i < 20; ++i) limiter.step({0, 0, 1}, kZero, kStep);
  limiter.release();
  EXPECT_EQ(limiter.step(kZero, kZero, kStep), kZero);
}

}  // namespace
}  // namespace microinjection
