#include <gtest/gtest.h>

#include <string>

#include "operation/teleoperation/haptic_bridge.h"
#include "operation/teleoperation/haptic_loop.h"

namespace microinjection {
namespace {

constexpr char kUnfelt[] = "the driver does not subscribe to the force";

/// What may be wrong at once, and what the bridge says of it: the first that is true.
struct Case {
  bool no_hand, no_needle, no_force, absent, clutch, unfelt;

  std::string why() const {
    if (no_hand) return "no valid hand position";
    if (unfelt) return kUnfelt;
    if (no_needle) return "no valid needle position";
    if (no_force) return "no valid force";
    if (absent) return "the operator is not present";
    return clutch ? "clutch is pressed" : "";
  }
};

constexpr int kCases = 64;
Case caseOf(int bits) {
  return {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0, (bits & 32) != 0};
}

HapticBridgeConfig configOf(const std::string& mode, const std::string& alignment, bool require_operator) {
  HapticBridgeConfig config;
  config.motion.mode = mode;
  config.engagement.mode = alignment;
  config.require_operator = require_operator;
  return config;
}

HapticBridge::Input good(double hand) {
  HapticBridge::Input input;
  input.hand = Eigen::Vector3d(0, 0, hand);
  input.needle = kNeedle;
  input.force.predicted = Eigen::Vector3d(0, 0, 1e-6);
  input.operator_present = true;
  return input;
}

void check(const HapticBridgeConfig& config, const Case& wrong) {
  HapticBridge bridge(config);
  HapticBridge::Output output;
  for (int i = 0; i < 200; ++i) output = bridge.step(good(0), kStep);
  ASSERT_EQ(output.state, Engagement::State::kFollow);
  ASSERT_NEAR(output.hand_force.z(), 0.2, 1e-9);

  HapticBridge::Input input = good(1e-3);
  if (wrong.no_hand) input.hand.reset();
  if (wrong.no_needle) input.needle.reset();
  if (wrong.no_force) input.force.predicted.reset();
  input.operator_present = !wrong.absent;
  input.clutch = wrong.clutch;
  if (wrong.unfelt) input.no_force_reason = kUnfelt;
  const Case counts{wrong.no_hand, wrong.no_needle, wrong.no_force, wrong.absent && config.require_operator,
                    wrong.clutch,  wrong.unfelt};
  output = bridge.step(input, kStep);
  EXPECT_EQ(output.hold_reason, counts.why());
  EXPECT_EQ(output.needle.has_value(), counts.why().empty()) << "at once";
  for (int i = 0; i < 100; ++i) output = bridge.step(input, kStep);
  EXPECT_EQ(output.hold_reason, counts.why());
  EXPECT_EQ(output.needle.has_value(), counts.why().empty());
  if (counts.why().empty()) return;
  EXPECT_EQ(output.state, Engagement::State::kHeld);
  EXPECT_EQ(output.hand_force, Eigen::Vector3d::Zero().eval());

  // All well again, and the hand within the tolerance and the dead zone: from here, and the force from nothing.
  output = bridge.step(good(1e-3), kStep);
  ASSERT_EQ(output.state, Engagement::State::kFollow) << output.hold_reason;
  EXPECT_EQ(*output.needle, kNeedle);
  EXPECT_LT(output.hand_force.norm(), 0.01 * 0.2 + 1e-9);
}

TEST(Presence, EveryCombinationOfClutchDeadManAndStaleInputs) {
  for (const char* mode : {"position", "rate"}) {
    for (const char* alignment : {"index", "agree"}) {
      for (const bool require_operator : {false, true}) {
        for (int bits = 0; bits < kCases; ++bits) {
          SCOPED_TRACE(std::string(mode) + " " + alignment + (require_operator ? " dead-man " : " ") +
                       std::to_string(bits));
          check(configOf(mode, alignment, require_operator), caseOf(bits));
        }
      }
    }
  }
}

/// One wrong thing after the other, without a step in between in which all is well.
TEST(Presence, AHoldLastsUntilItsLastReasonIsGone) {
  HapticBridge bridge(configOf("position", "index", true));
  for (int i = 0; i < 200; ++i) bridge.step(good(0), kStep);
  for (int first = 1; first < kCases; ++first) {
    for (int second = 1; second < kCases; ++second) {
      for (const int bits : {first, second}) {
        const Case wrong = caseOf(bits);
        HapticBridge::Input input = good(0);
        if (wrong.no_hand) input.hand.reset();
        if (wrong.no_needle) input.needle.reset();
        if (wrong.no_force) input.force.predicted.reset();
        input.operator_present = !wrong.absent;
        input.clutch = wrong.clutch;
        if (wrong.unfelt) input.no_force_reason = kUnfelt;
        const auto output = bridge.step(input, kStep);
        EXPECT_FALSE(output.needle) << first << " then " << second;
        EXPECT_EQ(output.hold_reason, wrong.why());
      }
    }
  }
  EXPECT_TRUE(bridge.step(good(0), kStep).needle);
}

}  // namespace
}  // namespace microinjection
