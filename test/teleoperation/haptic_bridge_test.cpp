#include "teleoperation/haptic_bridge.h"

#include <gtest/gtest.h>

#include <limits>

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s
const Eigen::Vector3d kNeedle(1e-6, 2e-6, 60e-6);
const Eigen::Vector3d kHand(0.1, 0.0, 0.05);

HapticBridge::Input trustedInput() {
  HapticBridge::Input input;
  input.hand = kHand;
  input.needle = kNeedle;
  input.force = Eigen::Vector3d(0, 0, 1e-6);
  return input;
}

class HapticBridgeTest : public testing::Test {
 protected:
  HapticBridge::Output run(const HapticBridge::Input& input, int steps) {
    HapticBridge::Output output;
    for (int i = 0; i < steps; ++i) output = bridge_.step(input, kStep);
    return output;
  }

  HapticBridgeConfig config_;
  HapticBridge bridge_{config_};
};

TEST_F(HapticBridgeTest, BeginsWhereTheNeedleIs) {
  const auto output = run(trustedInput(), 1);
  ASSERT_TRUE(output.needle);
  EXPECT_EQ(*output.needle, kNeedle);
}

TEST_F(HapticBridgeTest, ScalesTheHandsMotion) {
  run(trustedInput(), 1);
  HapticBridge::Input input = trustedInput();
  *input.hand += Eigen::Vector3d(0.01, -0.02, 0.03);
  const auto output = run(input, 1);
  EXPECT_LT((*output.needle - kNeedle - Eigen::Vector3d(10e-6, -20e-6, 30e-6)).norm(), 1e-15);
}

TEST_F(HapticBridgeTest, ForceComesWithTheCellsSignAndGain) {
  const auto output = run(trustedInput(), 200);
  EXPECT_LT((output.hand_force - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-12);
}

TEST_F(HapticBridgeTest, ForceRampsUpAndStaysBelowTheDevicesLimit) {
  HapticBridge::Input input = trustedInput();
  EXPECT_NEAR(run(input, 50).hand_force.z(), 0.1, 1e-9);  // half of the ramp
  input.force = Eigen::Vector3d(30e-6, 0, 40e-6);
  EXPECT_NEAR(run(input, 200).hand_force.norm(), config_.force_limit, 1e-12);
  EXPECT_NEAR(run(input, 1).hand_force.x() / run(input, 1).hand_force.z(), 0.75, 1e-12);
}

TEST_F(HapticBridgeTest, ClutchFloatsTheHandAndHoldsTheNeedle) {
  run(trustedInput(), 200);
  HapticBridge::Input input = trustedInput();
  input.clutch = true;
  *input.hand += Eigen::Vector3d(0.05, 0, 0);
  auto output = run(input, 10);
  EXPECT_FALSE(output.needle);
  EXPECT_EQ(output.hand_force, Eigen::Vector3d::Zero().eval());
  input.clutch = false;
  output = run(input, 1);
  EXPECT_EQ(*output.needle, kNeedle) << "the initials must be taken again on release";
  *input.hand += Eigen::Vector3d(0, 0, 0.001);
  EXPECT_NEAR((run(input, 1).needle->z() - kNeedle.z()), 1e-6, 1e-15);
}

TEST_F(HapticBridgeTest, UntrustedInputHoldsTheNeedleAndRendersNothing) {
  const Eigen::Vector3d nan = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  for (int which = 0; which < 6; ++which) {
    bridge_ = HapticBridge(config_);
    run(trustedInput(), 200);
    HapticBridge::Input input = trustedInput();
    std::optional<Eigen::Vector3d>* inputs[] = {&input.hand, &input.needle, &input.force};
    if (which < 3) {
      inputs[which]->reset();
    } else {
      *inputs[which - 3] = nan;
    }
    const auto output = run(input, 1);
    EXPECT_FALSE(output.needle) << which;
    EXPECT_EQ(output.hand_force, Eigen::Vector3d::Zero().eval()) << which;
    EXPECT_FALSE(output.held_because.empty()) << which;
    // Back again: no leap of the needle, no kick of the hand.
    HapticBridge::Input back = trustedInput();
    *back.hand += Eigen::Vector3d(0, 0, 0.2);
    const auto again = run(back, 1);
    EXPECT_EQ(*again.needle, kNeedle) << which;
    EXPECT_LT(again.hand_force.norm(), 0.01 * 0.2 + 1e-9) << which;
  }
}

}  // namespace
}  // namespace microinjection
