#include "teleoperation/engagement.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

using State = Engagement::State;

TEST(Engagement, FollowsAtOnceWhenTheHandIsSlow) {
  Engagement engagement{{}};
  EXPECT_EQ(engagement.state(), State::kHeld);
  EXPECT_EQ(engagement.step({true, false, 0, 0}), State::kHeld);
  EXPECT_EQ(engagement.step({false, false, 0, 0}), State::kFollow);
  EXPECT_EQ(engagement.step({false, false, 10, 10}), State::kFollow) << "a fast hand is followed once it leads";
  EXPECT_EQ(engagement.step({true, false, 0, 0}), State::kHeld);
}

TEST(Engagement, AFastHandIsNotTakenUp) {
  EngagementConfig config;
  Engagement engagement(config);
  EXPECT_EQ(engagement.step({false, false, 1.01 * config.speed, 0}), State::kAlign);
  EXPECT_EQ(engagement.why(), "the hand is fast");
  EXPECT_EQ(engagement.step({false, false, 0.99 * config.speed, 0}), State::kFollow);
  EXPECT_EQ(engagement.why(), "");
}

TEST(Engagement, IndexTakesUpTheHandWhereverItIs) {
  Engagement engagement{{}};
  engagement.step({false, false, 0, 0});
  engagement.step({true, false, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kFollow);
}

TEST(Engagement, AgreeWaitsForTheHandOrTheClutch) {
  EngagementConfig config;
  config.alignment = "agree";
  Engagement engagement(config);
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kFollow) << "nothing to agree with yet";
  engagement.step({true, false, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1.01 * config.tolerance}), State::kAlign);
  EXPECT_NE(engagement.why().find("press and release the clutch"), std::string::npos);
  EXPECT_EQ(engagement.step({false, false, 0, 0.99 * config.tolerance}), State::kFollow);
  engagement.step({true, false, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kAlign);
  engagement.step({true, true, 0, 1});
  EXPECT_EQ(engagement.step({false, false, 0, 1}), State::kFollow) << "gripped again";
}

TEST(Engagement, ADeviceThatSetsASpeedMustBeLetGoClutchOrNot) {
  for (const char* alignment : {"index", "agree"}) {
    EngagementConfig config;
    config.alignment = alignment;
    Engagement engagement(config);
    EXPECT_EQ(engagement.step({false, false, 0, 0, false}), State::kAlign) << "found deflected";
    EXPECT_NE(engagement.why().find("let go"), std::string::npos);
    EXPECT_EQ(engagement.step({false, false, 0, 0, true}), State::kFollow);
    EXPECT_EQ(engagement.step({false, false, 0, 0, false}), State::kFollow) << "deflected by who leads";
    for (const bool clutch : {false, true}) {
      engagement.step({true, clutch, 0, 0, false});
      EXPECT_EQ(engagement.step({false, false, 0, 0, false}), State::kAlign) << alignment << clutch;
      EXPECT_EQ(engagement.step({false, false, 0, 0, true}), State::kFollow) << alignment << clutch;
    }
  }
}

TEST(Engagement, HasNamesForDiagnostics) {
  EXPECT_EQ(Engagement::name(State::kHeld), "held");
  EXPECT_EQ(Engagement::name(State::kAlign), "align");
  EXPECT_EQ(Engagement::name(State::kFollow), "follow");
}

}  // namespace
}  // namespace microinjection
