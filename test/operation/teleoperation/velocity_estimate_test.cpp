#include "operation/teleoperation/velocity_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

Eigen::Vector3d encoder(double z) { return {0, 0, std::round(z / kResolution) * kResolution}; }

TEST(VelocityEstimate, IsQuietAtRestBetweenTwoTicks) {
  VelocityEstimate velocity(1.5 * kResolution);
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    velocity.add(encoder(i % 2 == 0 ? 0.4e-5 : 1.6e-5), kStep);
    if (i > 20) worst = std::max(worst, velocity.value().norm());
  }
  EXPECT_LT(worst, 2e-3) << "one period alone reads 20 mm/s";
}

TEST(VelocityEstimate, FollowsAReversalWithinAFewPeriods) {
  VelocityEstimate velocity(1.5 * kResolution);
  for (int i = 0; i < 100; ++i) velocity.add(encoder(0.2 * i * kStep), kStep);
  EXPECT_NEAR(velocity.value().z(), 0.2, 0.01);
  for (int i = 1; i <= 2; ++i) velocity.add(encoder(0.2 * (99 - i) * kStep), kStep);
  EXPECT_LT(velocity.value().z(), 0);
}

TEST(VelocityEstimate, CountsTheTimeThatPassed) {
  VelocityEstimate velocity(kResolution);
  double z = 0;
  for (int i = 0; i < 50; ++i) {
    const double dt = i % 3 == 0 ? 3e-3 : 1e-3;
    velocity.add({z += 0.1 * dt, 0, 0}, dt);
  }
  EXPECT_NEAR(velocity.value().x(), 0.1, 1e-9);
  velocity.reset();
  EXPECT_EQ(velocity.value(), Eigen::Vector3d::Zero().eval());
  velocity.add({5, 0, 0}, kStep);
  EXPECT_EQ(velocity.value(), Eigen::Vector3d::Zero().eval()) << "the first position is no motion";
}

}  // namespace
}  // namespace microinjection
