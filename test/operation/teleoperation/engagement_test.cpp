#include "operation/teleoperation/engagement.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

using State = Engagement::State;

TEST(Engagement, FollowsAtOnceWhenTheHandIsSlow) {
  Engagement engagement{{}};
  EXPECT_EQ(engagement.state(), State::kHeld);
  EXPECT_EQ(engagement.step({true, false, 0, 0}), State::kHeld);
  EXPECT_EQ(engagement.step({false, false, 0, 0}), State::kFollow);
  EXPECT_EQ(engagement.step({false, false, 0.24, 10}), State::kFollow) << "a faster one is followed once it leads";
  EXPECT_EQ(engagement.step({true, false, 0, 0}), State::kHeld);
}

TEST(Engagement, AFastHandIsNotTakenUp) {
  EngagementConfig config;
  Engagement engagement(config);
  EXPECT_EQ(engagement.step({false, false, 1.01 * config.speed, 0}), State::kAlign);
  EXPECT_EQ(engagement.reason(), "the hand is fast");
  EXPECT_EQ(engagement.step({false, false, 0.99 * config.speed, 0}), State::kFollow);
  EXPECT_EQ(engagement.reason(), "");
}

TEST(Engagement, AHandThatIsTooFastIsLostUntilItHasRested) {
  EngagementConfig config;
  Engagement engagement(config);
  engagement.step({});
  const double fast = 1.01 * config.speed_limit, slow = 0.99 * config.speed;
  const auto stepFor = [&](double time, double speed, double dt = 1e-3) {
    for (int i = 0; i < std::lround(time / dt); ++i) engagement.step({false, false, speed, 0, false, dt});
    return engagement.state();
  };
  EXPECT_EQ(stepFor(1, 0.99 * config.speed_limit), State::kFollow);
  EXPECT_EQ(stepFor(0.01, 100, 0.01), State::kFollow) << "one late sample";
  EXPECT_EQ(stepFor(1e-3, 0), State::kFollow);
  EXPECT_EQ(stepFor(config.speed_time, fast), State::kFollow);
  EXPECT_EQ(stepFor(1e-3, fast), State::kAlign);
  EXPECT_EQ(stepFor(config.rest_time - 2e-3, slow), State::kAlign);
  EXPECT_NE(engagement.reason().find("rest"), std::string::npos);
  EXPECT_EQ(stepFor(1e-3, 1.01 * config.speed), State::kAlign) << "it bounces";
  EXPECT_EQ(stepFor(config.rest_time - 2e-3, slow), State::kAlign);
  EXPECT_EQ(stepFor(3e-3, slow), State::kFollow);
}

TEST(Engagement, AHandThatLeapsIsLostAtOnce) {
  EngagementConfig config;
  Engagement engagement(config);
  engagement.step({});
  Engagement::Input leap;
  leap.leaps = true;
  EXPECT_EQ(engagement.step(leap), State::kAlign);
  EXPECT_NE(engagement.reason().find("rest"), std::string::npos);
  for (int i = 0; i < std::lround(config.rest_time / 1e-3) - 2; ++i) ASSERT_EQ(engagement.step({}), State::kAlign) << i;
  for (int i = 0; i < 4; ++i) engagement.step({});
  EXPECT_EQ(engagement.state(), State::kFollow);
  EXPECT_DOUBLE_EQ(config.longestStep(0.1), 0.1 * config.speed_limit);
  EXPECT_DOUBLE_EQ(config.longestStep(1e-4), 0.01 * config.speed_limit) << "stamps of a burst";
}

TEST(Engagement, AHandThatIsLostWhileHeldIsNotTakenUpAtOnceEither) {
  Engagement engagement{{}};
  engagement.step({});
  for (int i = 0; i < 5; ++i) engagement.step({false, false, 1, 0});
  engagement.step({true, false, 1, 0});
  EXPECT_EQ(engagement.step({}), State::kAlign);
}

TEST(Engagement, IndexTakesUpTheHandWhereverItIs) {
  Engagement engagement{{}};
  engagement.step({false, false, 0, 0});
  engagement.step({true, false, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kFollow);
}

TEST(Engagement, AgreeWaitsForTheHandOrTheClutch) {
  EngagementConfig config;
  config.mode = "agree";
  Engagement engagement(config);
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kFollow) << "nothing to agree with yet";
  engagement.step({true, false, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1.01 * config.tolerance}), State::kAlign);
  EXPECT_NE(engagement.reason().find("press and release the clutch"), std::string::npos);
  EXPECT_EQ(engagement.step({false, false, 0, 0.99 * config.tolerance}), State::kFollow);
  engagement.step({true, false, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kAlign);
  engagement.step({true, true, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kFollow) << "gripped again";
}

TEST(Engagement, ADeviceThatSetsASpeedMustBeLetGoClutchOrNot) {
  for (const char* alignment : {"index", "agree"}) {
    EngagementConfig config;
    config.mode = alignment;
    Engagement engagement(config);
    EXPECT_EQ(engagement.step({false, false, 0, 0, false, 1e-3, false}), State::kAlign) << "found deflected";
    EXPECT_NE(engagement.reason().find("let go"), std::string::npos);
    EXPECT_EQ(engagement.step({false, false, 0, 0, false, 1e-3, true}), State::kFollow);
    EXPECT_EQ(engagement.step({false, false, 0, 0, false, 1e-3, false}), State::kFollow) << "deflected by who leads";
    for (const bool clutch : {false, true}) {
      engagement.step({true, clutch, 0, 0, false, 1e-3, false});
      EXPECT_EQ(engagement.step({false, false, 0, 0, false, 1e-3, false}), State::kAlign) << alignment << clutch;
      EXPECT_EQ(engagement.step({false, false, 0, 0, false, 1e-3, true}), State::kFollow) << alignment << clutch;
    }
  }
}

TEST(Engagement, AStrokeThatIsInterruptedForAMomentGoesOn) {
  EngagementConfig config;
  const auto after = [&](double time, bool interrupted) {
    Engagement engagement(config);
    engagement.step({false, false, 0, 0});
    for (double held = 0; held < time - 1e-9; held += 0.01) engagement.step({true, false, 1, 0, interrupted, 0.01});
    return engagement.step({false, false, 2 * config.speed, 0});
  };
  EXPECT_EQ(after(0.9 * config.interruption, true), State::kFollow);
  EXPECT_EQ(after(1.1 * config.interruption, true), State::kAlign) << "the operator may take it for held";
  EXPECT_EQ(after(0.01, false), State::kAlign) << "clutch, dead-man or lost hand";
  Engagement falls(config);
  falls.step({});
  falls.step({true, false, 0, 0, true});
  EXPECT_EQ(falls.step({false, false, 1.01 * config.speed_limit, 0}), State::kAlign) << "no stroke";
  Engagement engagement(config);
  engagement.step({true, false, 1, 0, true, 0.01});
  EXPECT_EQ(engagement.step({false, false, 2 * config.speed, 0}), State::kAlign) << "it did not follow before";
}

TEST(Engagement, HasNamesForDiagnostics) {
  EXPECT_EQ(Engagement::name(State::kHeld), "held");
  EXPECT_EQ(Engagement::name(State::kAlign), "align");
  EXPECT_EQ(Engagement::name(State::kFollow), "follow");
}

}  // namespace
}  // namespace microinjection
