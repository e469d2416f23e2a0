#include "operation/control/expected_puncture.h"

#include <cmath>
#include <limits>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// The membrane of SpringRig fails at 1 uN, 10 um deep.
constexpr ExpectedPuncture kRight{0.8e-6, 1.2e-6, 8e-6, 12e-6};

class ExpectedPunctureTest : public InjectionFixture {
 protected:
  /// Number of steps of the indentation.
  /// @param strength  N, of the membrane
  int indent(const ExpectedPuncture& expected, double strength = 1e-6) {
    rig_ = SpringRig();
    rig_.puncture_force = strength;
    rig_.input.expected = expected;
    enable();
    EXPECT_TRUE(reach(InjectionState::kIndent));
    int count = 0;
    for (; controller_.injection() == InjectionState::kIndent && controller_.busy(); ++count) rig_.step(controller_);
    return count;
  }
};

TEST_F(ExpectedPunctureTest, WhatCannotBeIsNone) {
  EXPECT_TRUE(kRight.plausible());
  EXPECT_FALSE(ExpectedPuncture{}.plausible());
  for (const double bad : {kNan, -1e-6, 0.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE((ExpectedPuncture{bad, 1.2e-6, 8e-6, 12e-6}.plausible())) << bad;
    EXPECT_FALSE((ExpectedPuncture{0.8e-6, bad, 8e-6, 12e-6}.plausible())) << bad;
    EXPECT_FALSE((ExpectedPuncture{0.8e-6, 1.2e-6, bad, 12e-6}.plausible())) << bad;
    EXPECT_FALSE((ExpectedPuncture{0.8e-6, 1.2e-6, 8e-6, bad}.plausible())) << bad;
  }
}

TEST_F(ExpectedPunctureTest, TheStabIsFastFromTheStartAndWithinItsOvershoot) {
  config_.motion.overshoot = 1e-6;
  const int known = indent(kRight);
  ASSERT_TRUE(reach(InjectionState::kInject));
  const double deepest = rig_.deepest;
  const int unknown = indent({});
  EXPECT_LT(known, 0.9 * unknown);
  EXPECT_LT(deepest, 10e-6 + config_.goal.margin + config_.motion.overshoot);
}

TEST_F(ExpectedPunctureTest, WhatCannotBeChangesNothing) {
  const int unknown = indent({});
  EXPECT_EQ(indent({kNan, kNan, kNan, kNan}), unknown);
  EXPECT_EQ(indent({1.2e-6, 0.8e-6, 8e-6, 12e-6}), unknown);
}

TEST_F(ExpectedPunctureTest, APunctureAboveTheForceLimitIsNotTried) {
  indent({1.1 * config_.guards.force_limit, 2 * config_.guards.force_limit, 8e-6, 12e-6});
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("force_limit"), std::string::npos) << controller_.result().reason;
  EXPECT_LT(rig_.deepest, 2e-6);
  expectSafe("above the force limit");
}

TEST_F(ExpectedPunctureTest, APunctureBelowTheGoalsDepthIsNotTried) {
  indent({0.8e-6, 1.2e-6, 1.1 * config_.goal.depth, 2 * config_.goal.depth});
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("depth_limit"), std::string::npos) << controller_.result().reason;
  EXPECT_LT(rig_.deepest, 2e-6);
}

TEST_F(ExpectedPunctureTest, AMembraneThatHoldsMoreEndsTheInjection) {
  const double most = (1 + config_.expectation.beyond) * 0.6e-6;
  indent({0.4e-6, 0.6e-6, 8e-6, 12e-6}, 5e-6);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("the membrane holds"), std::string::npos) << controller_.result().reason;
  EXPECT_GT(rig_.largest_force, most - 5 * rig_.noise);
  EXPECT_LT(rig_.largest_force, 1.3 * most);  // within some steps of a stab, and the rig's lag
  expectSafe("a strong membrane");
}

TEST_F(ExpectedPunctureTest, SaysNothingOfTheNextMembrane) {
  rig_.second_force = 1.5e-6;
  rig_.input.expected = ExpectedPuncture{0.8e-6, 0.9e-6, 8e-6, 12e-6};
  rig_.puncture_force = 0.8e-6;
  config_.goal.layers = 2;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

TEST_F(ExpectedPunctureTest, AnIndentationExpectsNone) {
  config_.goal.puncture = false;
  config_.goal.depth = 5e-6;
  rig_.input.expected = ExpectedPuncture{0.1e-6, 0.2e-6, 1e-6, 2e-6};
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kIndented) << controller_.result().reason;
}

}  // namespace
}  // namespace microinjection
