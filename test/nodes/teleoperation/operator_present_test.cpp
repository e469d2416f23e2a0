#include <gtest/gtest.h>

#include "bridge_world.h"

namespace microinjection {
namespace {

/// The needle follows only while the device says that the operator is there.
class OperatorPresentTest : public testing::Test {
 protected:
  OperatorPresentTest()
      : OperatorPresentTest(
            "{require_operator: true, timeouts: {operator_present: 0.1, predicted: 0.3, clutch: 0.1}}") {}
  explicit OperatorPresentTest(const std::string& changes, const std::vector<std::string>& overrides = {})
      : bridge_(changes, overrides) {
    sayAllGood(0.2);
  }

  void sayAllGood(double seconds) {
    bridge_.sayGood();
    world().repeat(kClutch, joyMessage({0}));
    world().repeat(kPresent, joyMessage({1}));
    bridge_.run(seconds);
    ASSERT_TRUE(bridge_.follows());
  }
  TestNode& world() { return bridge_.world(); }

  BridgeWorld bridge_;
};

TEST_F(OperatorPresentTest, Absent) {
  EXPECT_GT(bridge_.force().z(), 0.1);
  world().repeat(kPresent, joyMessage({0}));
  bridge_.run(0.2);
  EXPECT_FALSE(bridge_.follows());
  EXPECT_EQ(bridge_.force().norm(), 0);
}

TEST_F(OperatorPresentTest, WhatCannotBeReadIsNoOperator) {
  world().repeat(kPresent, joyMessage({}));
  bridge_.run(0.2);
  EXPECT_FALSE(bridge_.follows());
  sayAllGood(0.2);
  world().repeatInvalid<sensor_msgs::Joy>(kPresent);
  bridge_.run(0.2);
  EXPECT_FALSE(bridge_.follows());
}

TEST_F(OperatorPresentTest, EveryCombinationOfClutchAndOperator) {
  struct Said {
    const char* name;
    std::function<void(TestNode&, const std::string& topic)> say;
  };
  const Said released{"0", [](auto& world, auto& topic) { world.repeat(topic, joyMessage({0})); }};
  const Said pressed{"1", [](auto& world, auto& topic) { world.repeat(topic, joyMessage({1})); }};
  const Said empty{"no buttons", [](auto& world, auto& topic) { world.repeat(topic, joyMessage({})); }};
  const Said invalid{"invalid",
                     [](auto& world, auto& topic) { world.template repeatInvalid<sensor_msgs::Joy>(topic); }};
  const Said silent{"silent", [](auto& world, auto& topic) { world.silence(topic); }};
  for (const Said& clutch : {released, pressed, empty, invalid, silent}) {
    for (const Said& present : {released, pressed, empty, invalid, silent}) {
      SCOPED_TRACE(std::string("clutch ") + clutch.name + ", operator " + present.name);
      sayAllGood(0.02);
      clutch.say(world(), kClutch);
      present.say(world(), kPresent);
      bridge_.run(0.12);
      EXPECT_EQ(bridge_.follows(), clutch.name == released.name && present.name == pressed.name);
    }
  }
}

TEST_F(OperatorPresentTest, EachInputIsStaleAfterItsOwnTime) {
  const std::pair<const char*, double> timeouts[] = {{kPresent, 0.1}, {kClutch, 0.1},    {kHand, 0.05},
                                                     {kNeedle, 0.05}, {kPredicted, 0.3}, {kController, 0.25}};
  for (const auto& [topic, timeout] : timeouts) {
    SCOPED_TRACE(topic);
    sayAllGood(0.2);
    world().silence(topic);
    bridge_.run(timeout - 1e-3);
    EXPECT_TRUE(bridge_.follows());
    bridge_.run(3e-3);
    EXPECT_FALSE(bridge_.follows());
  }
}

/// A device with pedals, whose driver tells a button when it changes: config/haptic/external.yaml.
class ButtonsOnChangeTest : public OperatorPresentTest {
 protected:
  ButtonsOnChangeTest()
      : OperatorPresentTest("{timeouts: {predicted: 0.3, clutch: 0, hand_unchanged: 0}}",
                            {"hand.device:=external", "hand.require_operator:=true"}) {
    silenceButtons();
  }
  void silenceButtons() {
    world().silence(kClutch);
    world().silence(kPresent);
  }
};

TEST_F(ButtonsOnChangeTest, WhatWasToldLastHolds) {
  bridge_.run(2);
  EXPECT_TRUE(bridge_.follows());
  world().sayNow(kPresent, joyMessage({0}));
  bridge_.run(0.02);
  EXPECT_FALSE(bridge_.follows());
}

TEST_F(ButtonsOnChangeTest, ButNotPastAPoseThatWasStale) {
  world().silence(kHand);
  bridge_.run(0.2);
  bridge_.sayGood();
  bridge_.run(0.5);
  EXPECT_FALSE(bridge_.follows());
}

/// However long ago the other one has told a change, it may tell the next. Whichever is left, the operator presses
/// anew.
TEST_F(ButtonsOnChangeTest, OfTwoNodesAreNoButtonsAndBothAreNamed) {
  for (const auto& [topic, leads] : {std::pair(kClutch, 0), std::pair(kPresent, 1)}) {
    SCOPED_TRACE(topic);
    sayAllGood(0.2);
    silenceButtons();
    bridge_.run(2);
    const std::string name = std::string("stranger_") + (leads ? "operator" : "clutch");
    TestNode& stranger = bridge_.session().addTestNode(name);
    stranger.sayNow(topic, joyMessage({leads}));
    bridge_.run(1.5);
    EXPECT_FALSE(bridge_.follows());
    world().sayNow(topic, joyMessage({leads}));
    bridge_.run(1.5);
    EXPECT_FALSE(bridge_.follows());
    const std::string said = bridge_.session().diagnostics().text("haptic_bridge: inputs");
    EXPECT_NE(said.find(std::string(topic) + " is sent by two nodes, /" + name + " and /world"), std::string::npos)
        << said;
    bridge_.run(3);  // past the time of a successor
    EXPECT_FALSE(bridge_.follows());
    bridge_.session().executive().kill(name);
    bridge_.run(1);
    EXPECT_FALSE(bridge_.follows());
    world().sayNow(kPresent, joyMessage({1}));
    bridge_.run(0.2);
    EXPECT_TRUE(bridge_.follows());
  }
}

TEST_F(ButtonsOnChangeTest, ATapLeavesNoButtonHeldDown) {
  const std::pair<const char*, bool> buttons[] = {{kClutch, true}, {kPresent, false}};
  for (const int tapped : {2, 3}) {
    for (const auto& [topic, follows] : buttons) {
      SCOPED_TRACE(std::string(topic) + " " + std::to_string(tapped));
      sayAllGood(0.2);
      silenceButtons();
      world().sayNow(topic, joyMessage({tapped}));
      bridge_.run(0.02);
      EXPECT_EQ(bridge_.follows(), follows);
    }
  }
}

}  // namespace
}  // namespace microinjection
