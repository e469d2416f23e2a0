#include "operation/teleoperation/haptic_bridge.h"

#include <gtest/gtest.h>

#include <limits>

#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

HapticBridge::Input trustedInput() {
  HapticBridge::Input input;
  input.hand = kHand;
  input.needle = kNeedle;
  input.force.predicted = Eigen::Vector3d(0, 0, 1e-6);
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
  input.force.predicted = Eigen::Vector3d(30e-6, 0, 40e-6);
  EXPECT_NEAR(run(input, 200).hand_force.norm(), config_.limits.force, 1e-12);
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
    std::optional<Eigen::Vector3d>* inputs[] = {&input.hand, &input.needle, &input.force.predicted};
    if (which < 3) {
      inputs[which]->reset();
    } else {
      *inputs[which - 3] = nan;
    }
    auto output = run(input, 1);
    EXPECT_FALSE(output.needle) << which;
    EXPECT_FALSE(output.hold_reason.empty()) << which;
    EXPECT_EQ(output.state, Engagement::State::kHeld) << which;
    if (which % 3 != 0) {  // the hand is known: its force falls by the limiter's rate, 0.2 N at 100 N/s
      EXPECT_NEAR(output.hand_force.norm(), 0.1, 1e-9) << which;
      output = run(input, 1);
    }
    EXPECT_EQ(output.hand_force, Eigen::Vector3d::Zero().eval()) << which;
    // Back again, where it leapt to: no leap of the needle, no kick of the hand, once the hand rests.
    HapticBridge::Input back = trustedInput();
    *back.hand += Eigen::Vector3d(0, 0, 0.2);
    for (int i = 0; i < 20 && output.state != Engagement::State::kFollow; ++i) {
      EXPECT_FALSE(output.needle) << which;
      output = run(back, 1);
    }
    ASSERT_TRUE(output.needle) << which;
    EXPECT_EQ(*output.needle, kNeedle) << which;
    EXPECT_LT(output.hand_force.norm(), 0.01 * 0.2 + 1e-9) << which;
  }
}

TEST_F(HapticBridgeTest, HoldsForAReasonFromOutsideAndEngagesAnew) {
  run(trustedInput(), 200);
  HapticBridge::Input input = trustedInput();
  input.no_motion_reason = "calibration";
  const auto held = run(input, 50);  // 0.2 N at 100 N/s are gone after 2 ms
  EXPECT_FALSE(held.needle);
  EXPECT_EQ(held.hand_force, Eigen::Vector3d::Zero());
  EXPECT_EQ(held.hold_reason, "calibration");
  *input.hand += Eigen::Vector3d(0.04, 0, 0);
  run(input, 50);
  input.no_motion_reason = "";
  const auto again = run(input, 200);
  ASSERT_TRUE(again.needle);
  EXPECT_EQ(*again.needle, kNeedle) << "the needle does not take the hand's way of the hold";
}

TEST_F(HapticBridgeTest, HoldsUnlessTheOperatorIsPresent) {
  config_.require_operator = true;
  bridge_ = HapticBridge(config_);
  auto output = run(trustedInput(), 200);
  EXPECT_FALSE(output.needle);
  EXPECT_EQ(output.hand_force, Eigen::Vector3d::Zero().eval());
  EXPECT_EQ(output.hold_reason, "the operator is not present");
  HapticBridge::Input input = trustedInput();
  input.operator_present = true;
  output = run(input, 200);
  EXPECT_TRUE(output.needle);
  EXPECT_NEAR(output.hand_force.z(), 0.2, 1e-9);
  EXPECT_FALSE(run(trustedInput(), 1).needle) << "let go";
}

TEST_F(HapticBridgeTest, FramesTurnMotionForwardAndForceBack) {
  config_.frame.device_axes = "x -z y";
  bridge_ = HapticBridge(config_);
  run(trustedInput(), 1);
  HapticBridge::Input input = trustedInput();
  *input.hand += Eigen::Vector3d(0, 0.01, 0);  // the device's y is the world's z
  const auto output = run(input, 200);
  EXPECT_LT((*output.needle - kNeedle - Eigen::Vector3d(0, 0, 10e-6)).norm(), 1e-12);
  EXPECT_LT((output.hand_force - Eigen::Vector3d(0, 0.2, 0)).norm(), 1e-9);
}

TEST_F(HapticBridgeTest, AgreeHoldsUntilTheHandIsBack) {
  config_.engagement.mode = "agree";
  bridge_ = HapticBridge(config_);
  run(trustedInput(), 100);
  HapticBridge::Input input = trustedInput();
  input.force.predicted.reset();
  run(input, 10);
  input = trustedInput();
  *input.hand += Eigen::Vector3d(0, 0, 0.05);
  auto output = run(input, 100);
  EXPECT_EQ(output.state, Engagement::State::kAlign);
  EXPECT_FALSE(output.needle);
  EXPECT_EQ(output.hand_force, Eigen::Vector3d::Zero().eval());
  EXPECT_FALSE(output.hold_reason.empty());
  output = run(trustedInput(), 100);
  EXPECT_EQ(output.state, Engagement::State::kFollow);
  EXPECT_LT((*output.needle - kNeedle).norm(), 1e-12);
}

TEST_F(HapticBridgeTest, ANeedleBehindTheWallFeelsTheWallAndStaysBeforeIt) {
  config_.fixtures.wall = true;
  config_.fixtures.wall_point = {0, 0, 50e-6};
  bridge_ = HapticBridge(config_);
  HapticBridge::Input input = trustedInput();
  input.force.predicted = Eigen::Vector3d::Zero();
  run(input, 150);
  for (int i = 1; i <= 150; ++i) {
    *input.hand = kHand - Eigen::Vector3d(0, 0, i * 1e-4);  // 15 um down at 0.1 m/s, the wall is 10 um away
    run(input, 1);
  }
  const auto output = run(input, 100);
  EXPECT_NEAR(output.needle->z(), 50e-6, 1e-12);
  EXPECT_NEAR(output.hand_force.z(), config_.fixtures.limit_stiffness * 5e-3, 1e-6);
}

TEST_F(HapticBridgeTest, AClutchInContactDoesNotLoseTheCellsEnergy) {
  // Pressed in on 60 N/m to 1.2 N, clutched while the hand goes 0.1 m back, and out again.
  HapticBridge::Input input = trustedInput();
  const auto at = [&](double depth) {  // m of the hand
    input.hand->z() = kHand.z() - depth;
    input.force.predicted = Eigen::Vector3d(0, 0, std::max(0.0, 60 * depth) / config_.force_gain);
    return run(input, 1).hand_force.z();
  };
  for (int i = 0; i < 200; ++i) at(0);
  for (int i = 0; i <= 1000; ++i) at(0.02 * i / 1000);
  input.clutch = true;
  for (int i = 0; i < 200; ++i) {
    input.hand->z() += 0.5e-3;
    run(input, 1);
  }
  input.clutch = false;
  const double z = input.hand->z();
  double given = 0;
  for (int i = 0; i <= 2000; ++i) {
    const double depth = 0.02 * (1 - std::max(0, i - 1000) / 1000.0);
    input.hand->z() = z + 0.02 - depth;
    input.force.predicted = Eigen::Vector3d(0, 0, 60 * depth / config_.force_gain);
    given += run(input, 1).hand_force.z() * (i > 1000 ? 0.02 / 1000 : 0);
  }
  EXPECT_GT(given, 0.85 * 0.5 * 60 * 0.02 * 0.02);
}

TEST_F(HapticBridgeTest, PunctureDoesNotKick) {
  HapticBridge::Input input = trustedInput();
  input.force.predicted = Eigen::Vector3d(0, 0, 7.5e-6);  // 1.5 N at the hand
  double before = run(input, 300).hand_force.z();
  EXPECT_NEAR(before, 1.5, 1e-9);
  input.force.predicted = Eigen::Vector3d::Zero();
  int steps = 0;
  for (; steps < 100 && before > 0; ++steps) {
    const double force = run(input, 1).hand_force.z();
    EXPECT_LE(before - force, config_.limits.rate * kStep + 1e-12);
    before = force;
  }
  EXPECT_EQ(steps, 15);
}

TEST_F(HapticBridgeTest, AForceThatPushesForeverIsWithheld) {
  // A sensor that drifts, a model with the wrong sign: the hand is pushed and gives way.
  const auto energyAfter = [&](bool enabled) {
    config_.passivity.enabled = enabled;
    bridge_ = HapticBridge(config_);
    HapticBridge::Input input = trustedInput();
    input.force.predicted = Eigen::Vector3d(0, 0, 10e-6);  // 2 N; 20 N s/m take 1 N off
    for (int i = 0; i < 1000; ++i) {
      input.hand->z() += 0.05 * kStep;
      bridge_.step(input, kStep);
    }
    return bridge_.observedEnergy();
  };
  EXPECT_LT(energyAfter(false), -10 * config_.passivity.reserve);
  EXPECT_GT(energyAfter(true), -config_.passivity.reserve);
  EXPECT_TRUE(bridge_.passivityActing());
}

}  // namespace
}  // namespace microinjection
