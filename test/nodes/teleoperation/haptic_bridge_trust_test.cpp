#include <gtest/gtest.h>

#include "bridge_world.h"

namespace microinjection {
namespace {

/// The bridge renders zero force and withdraws its target while hand, needle, controller or force is not valid.
class HapticBridgeTrustTest : public testing::Test {
 protected:
  /// `spoil` replaces messages that were good.
  void expectHeld(const std::function<void()>& spoil, const std::string& reason) {
    SCOPED_TRACE(reason);
    bridge_.sayGood();
    bridge_.run(0.2);
    EXPECT_LT((bridge_.force() - Eigen::Vector3d(0, 0, 0.2)).norm(), 0.2e-12);
    EXPECT_TRUE(bridge_.follows());
    spoil();
    bridge_.run(0.3);
    EXPECT_EQ(bridge_.force().norm(), 0);
    EXPECT_FALSE(bridge_.follows());
    const auto* status = bridge_.session().diagnostics().of("haptic_bridge: loop");
    ASSERT_TRUE(status);
    EXPECT_NE(status->level, diagnostic_msgs::DiagnosticStatus::OK);
    EXPECT_NE(status->message.find(reason), std::string::npos) << status->message;
  }
  TestNode& world() { return bridge_.world(); }

  BridgeWorld bridge_{"{diagnostic_period: 0.1}"};
};

TEST_F(HapticBridgeTrustTest, HandThatIsSilentOrNotFinite) {
  expectHeld([&] { world().silence(kHand); }, "no valid hand position");
  expectHeld([&] { world().repeat(kHand, poseMessage(NAN, 0, 0, "haptic")); }, "no valid hand position");
}

TEST_F(HapticBridgeTrustTest, NeedleThatIsSilentOrNotFinite) {
  expectHeld([&] { world().silence(kNeedle); }, "no valid needle position");
  expectHeld([&] { world().repeat(kNeedle, poseMessage(0, 0, INFINITY)); }, "no valid needle position");
}

TEST_F(HapticBridgeTrustTest, ControllerThatIsSilent) {
  expectHeld([&] { world().silence(kController); }, "the controller is silent");
}

TEST_F(HapticBridgeTrustTest, ClutchThatCannotBeReadIsPressed) {
  world().sayNow(kClutch, joyMessage({0}));
  bridge_.run(0.2);
  EXPECT_TRUE(bridge_.follows());
  world().say(kClutch, sensor_msgs::Joy());
  bridge_.run(0.2);
  EXPECT_FALSE(bridge_.follows());
  world().sayNow(kClutch, joyMessage({0}));
  bridge_.run(0.2);
  EXPECT_TRUE(bridge_.follows());
}

TEST_F(HapticBridgeTrustTest, ForceThatIsInvalidSilentNotFiniteOrOfAnotherFrame) {
  expectHeld([&] { world().repeatInvalid<geometry_msgs::WrenchStamped>(kPredicted); }, "no valid force");
  expectHeld([&] { world().silence(kPredicted); }, "no valid force");
  expectHeld([&] { world().repeat(kPredicted, wrenchMessage(0, NAN, 0)); }, "no valid force");
  expectHeld([&] { world().repeat(kPredicted, wrenchMessage(0, 0, 1e-6, "camera")); }, "no valid force");
}

}  // namespace
}  // namespace microinjection
