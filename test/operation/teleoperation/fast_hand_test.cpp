#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "operation/teleoperation/hand_motion.h"
#include "operation/teleoperation/haptic_bridge.h"
#include "operation/teleoperation/haptic_loop.h"
#include "operation/teleoperation/virtual_hand.h"

namespace microinjection {
namespace {

constexpr double kGravity = 9.81;  // m/s^2

/// A stylus let go `height` (m) above its rest, the force on it left out (what it feels slows it down), that bounces
/// with half of its speed. Returns how far (m) the needle has gone down after 3 s.
double sunk(const HapticBridgeConfig& config, double height) {
  HapticBridge bridge(config);
  HapticBridge::Input input;
  input.force.predicted = Eigen::Vector3d(0, 0, 0.1e-6);
  double needle = 0, z = 0, speed = 0;
  for (int i = 0; i < 3500; ++i) {
    if (i >= 500) {
      speed -= kGravity * kStep;
      z += speed * kStep;
      if (z < -height) z = -height, speed *= -0.5;
    }
    input.hand = Eigen::Vector3d(0, 0, std::round(z / kResolution) * kResolution);
    input.needle = Eigen::Vector3d(0, 0, needle);
    const HapticBridge::Output output = bridge.step(input, kStep);
    if (output.needle) needle = output.needle->z();
    if (i == 499) {
      EXPECT_EQ(output.state, Engagement::State::kFollow);
    }
  }
  return -needle;
}

TEST(FastHand, AStylusThatWasLetGoDoesNotTakeTheNeedleDown) {
  for (const char* alignment : {"index", "agree"}) {
    HapticBridgeConfig config;
    config.engagement.mode = alignment;
    // It has fallen 3.2 mm when it has reached the limit, 5 mm when that was noticed.
    const double height = 0.1, noticed = 7e-3;
    EXPECT_LT(sunk(config, height), config.motion.position_scale * noticed) << alignment;
    config.engagement.speed_limit = 10;
    EXPECT_GT(sunk(config, height), config.motion.position_scale * 5 * noticed) << "so the limit it was";
  }
}

TEST(FastHand, TheForceOfAHandThatIsTooFastFallsByTheLimitersRate) {
  HapticBridgeConfig config;
  config.passivity.enabled = false;
  HapticBridge bridge(config);
  HapticBridge::Input input;
  input.hand = input.needle = Eigen::Vector3d::Zero();
  input.force.predicted = Eigen::Vector3d(0, 0, 10e-6);
  HapticBridge::Output output;
  for (int i = 0; i < 500; ++i) output = bridge.step(input, kStep);
  double before = output.hand_force.z();
  EXPECT_NEAR(before, 2, 1e-9);
  for (int i = 0; i < 100; ++i) {
    input.hand->x() += 0.5 * kStep;
    output = bridge.step(input, kStep);
    EXPECT_LE(before - output.hand_force.z(), config.limits.rate * kStep + 1e-12);
    before = output.hand_force.z();
  }
  EXPECT_FALSE(output.needle);
  EXPECT_EQ(output.hold_reason, "the hand is fast");
  EXPECT_EQ(output.hand_force, Eigen::Vector3d::Zero().eval());
}

TEST(FastHand, MotionsThatAreShippedAreSlowEnough) {
  int files = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(std::string(MICROINJECTION_SOURCE_DIR) + "/config/hand_motions")) {
    const HandMotion motion = HandMotion::load(file.path());
    VirtualHand hand({}, motion.at(0).position);
    double fastest = 0;
    for (double time = 0; time < motion.duration(); time += kStep) {
      const Eigen::Vector3d before = hand.position();
      fastest =
          std::max(fastest, (hand.step(motion.at(time).position, Eigen::Vector3d::Zero(), kStep) - before).norm());
    }
    EXPECT_GT(fastest, 0);
    EXPECT_LT(fastest / kStep, 0.2 * EngagementConfig().speed_limit) << file.path();
    ++files;
  }
  EXPECT_GE(files, 2);
}

TEST(FastHand, APunctureAtTheDevicesLimitDoesNotLoseTheHand) {
  const HapticBridgeConfig config;
  VirtualHand hand({}, Eigen::Vector3d::Zero());
  double force = config.limits.force, fastest = 0;
  for (int i = 0; i < 3000; ++i) {
    if (i >= 2000) force = std::max(0.0, force - config.limits.rate * kStep);
    const double before = hand.position().z();
    hand.step(Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, force), kStep);
    if (i >= 2000) fastest = std::max(fastest, std::abs(hand.position().z() - before) / kStep);
  }
  EXPECT_GT(fastest, config.engagement.speed) << "it is no slow one";
  EXPECT_LT(fastest, config.engagement.speed_limit);
}

}  // namespace
}  // namespace microinjection
