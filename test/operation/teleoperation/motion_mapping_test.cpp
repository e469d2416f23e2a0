#include "operation/teleoperation/motion_mapping.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

TEST(MotionMapping, PositionModeScalesFromTheAnchor) {
  MotionMapping mapping{{}};
  mapping.setReference(kHand, kNeedle);
  EXPECT_EQ(mapping.step(kHand, 1e-3), kNeedle);
  const Eigen::Vector3d target = mapping.step(kHand + Eigen::Vector3d(0.01, 0, -0.02), 1e-3);
  EXPECT_LT((target - kNeedle - Eigen::Vector3d(10e-6, 0, -20e-6)).norm(), 1e-17);
  EXPECT_NEAR(mapping.misalignment(kHand + Eigen::Vector3d(0.01, 0, -0.02), target), 0, 1e-12);
  EXPECT_NEAR(mapping.misalignment(kHand, target), std::hypot(0.01, 0.02), 1e-12);
}

class RateMode : public testing::Test {
 protected:
  RateMode() {
    config_.mode = "rate";
    mapping_ = std::make_unique<MotionMapping>(config_);
    mapping_->setReference(kHand, kNeedle);  // a hand that was deflected is no other zero
  }
  Eigen::Vector3d after(const Eigen::Vector3d& deflection, int steps) {
    Eigen::Vector3d target;
    for (int i = 0; i < steps; ++i) target = mapping_->step(deflection, 1e-3);
    return target - kNeedle;
  }
  MotionMappingConfig config_;
  std::unique_ptr<MotionMapping> mapping_;
};

TEST_F(RateMode, MovesNothingWithinTheDeadZone) {
  EXPECT_EQ(after({0, 0, 0.99 * config_.dead_zone}, 1000), Eigen::Vector3d::Zero().eval());
}

TEST_F(RateMode, IsLetGoWithinTheDeadZoneOfTheDevicesZero) {
  EXPECT_TRUE(mapping_->isAtRest({0, 0, 0.99 * config_.dead_zone}));
  EXPECT_FALSE(mapping_->isAtRest({0, 0, -1.01 * config_.dead_zone}));
  EXPECT_FALSE(mapping_->isAtRest(kHand));
  EXPECT_EQ(mapping_->misalignment({0, 0, 1}, kNeedle + Eigen::Vector3d::UnitX()), 0);
}

TEST_F(RateMode, SpeedGrowsFromTheDeadZonesBorder) {
  const Eigen::Vector3d moved = after({0, 0, -config_.dead_zone - 0.01}, 1000);
  EXPECT_NEAR(moved.z(), -config_.rate_gain * 0.01, 1e-12);  // in 1 s
  EXPECT_EQ(after({0, 0, 0}, 100).z(), moved.z()) << "letting go stops";
}

TEST_F(RateMode, SpeedIsLimitedAlongTheDeflection) {
  const Eigen::Vector3d moved = after({0.3, 0, 0.4}, 1000);
  EXPECT_NEAR(moved.norm(), config_.rate_limit, 1e-12);
  EXPECT_NEAR(moved.x() / moved.z(), 0.75, 1e-9);
}

TEST_F(RateMode, GoesOnFromALimitItMet) {
  after({0, 0, -0.1}, 1000);
  mapping_->limitTo(kNeedle);
  EXPECT_NEAR(after({0, 0, 0.1}, 100).z(), 0.1 * config_.rate_limit, 1e-12);
}

}  // namespace
}  // namespace microinjection
