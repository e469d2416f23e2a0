// The holder keeps its pressure, whatever fails, and says why; only a set-point of one node at a time changes it.

#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include <cmath>

#include "cell_microinjection/HoldingSeal.h"
#include "holder_world.h"

namespace microinjection {
namespace {

constexpr double kSilent = 1;  // s, commander_timeout of config/holder.yaml
constexpr double kSuction = -2000;

class HolderTest : public testing::Test {
 protected:
  HolderTest() {
    session_.add("holder", "{diagnostic_period: 0.1}");
    session_.run(0.2);
    holder_.set(kSuction);
    session_.run(3);  // fifteen times the line's time constant
    EXPECT_NEAR(holder_.state().pressure, kSuction, 1);
  }
  void expectKept(double seconds = 3) {
    for (const double end = session_.now().toSec() + seconds; session_.now().toSec() < end; session_.run(0.25)) {
      EXPECT_NEAR(holder_.state().pressure, kSuction, 1);
      EXPECT_NEAR(holder_.state().source_pressure, kSuction, 1);
      EXPECT_EQ(holder_.state().target, kSuction);
    }
  }
  void expectSaid(const std::string& text) {
    session_.run(0.3);
    EXPECT_NE(session_.diagnostics().text("holder: pressure").find(text), std::string::npos)
        << session_.diagnostics().text("holder: pressure");
  }

  VirtualSession session_{{"holder:=sim"}};
  TestNode& other_ = session_.addTestNode("other");
  HolderWorld holder_{session_};
};

TEST_F(HolderTest, WhatIsNoTimelyPressureIsRefusedAndThePressureKept) {
  const std::pair<double, double> bad[] = {{NAN, 0}, {INFINITY, 0}, {1e9, 0}, {-30e3, 0}, {0, 0.7}, {0, -0.7}};
  for (const auto& [pressure, age] : bad) {
    holder_.set(pressure, age);
    session_.run(0.05);
    EXPECT_NE(holder_.state().refusal, "") << pressure << ", " << age;
  }
  EXPECT_EQ(holder_.state().refusal, "set_pressure refused: it is from the future");
  session_.world().say("holder/set_pressure", sensor_msgs::FluidPressure());
  session_.run(0.05);
  EXPECT_EQ(holder_.state().refusal, "set_pressure refused: its stamp is 0");
  expectKept();
}

TEST_F(HolderTest, NeitherDisableNorPauseLetsGo) {
  const std::pair<const char*, const char*> commands[] = {
      {"pause", "PAUSED"}, {"disable", "DISABLED"}, {"pause", "DISABLED"}, {"enable", "ENABLED"}};
  for (const auto& [word, state] : commands) {
    holder_.command(word);
    session_.run(0.05);
    EXPECT_EQ(holder_.state().state, state);
    EXPECT_EQ(holder_.operating().state, state);
    if (holder_.state().state == "ENABLED") continue;
    expectSaid(std::string("the holder is ") + state + ": its pressure is kept");
    holder_.set(0);
    session_.run(0.05);
    EXPECT_EQ(holder_.state().refusal, std::string("set_pressure refused: state is ") + state);
  }
  expectKept(1);
  for (const char* word : {"home", "unhome", "stop", "let go"}) {
    holder_.command(word);
    session_.run(0.05);
    EXPECT_NE(holder_.state().refusal.find("is no command here; allowed: enable, disable, pause, resume"),
              std::string::npos);
  }
  holder_.set(-500);
  session_.run(3);
  EXPECT_NEAR(holder_.state().pressure, -500, 1);
}

TEST_F(HolderTest, ACommanderThatFallsSilentLetsNothingGo) {
  EXPECT_EQ(holder_.state().kept, "") << "one set-point needs no second";
  sensor_msgs::FluidPressure message;
  message.fluid_pressure = kSuction;
  session_.world().repeat("holder/set_pressure", message);
  session_.run(0.5);
  EXPECT_EQ(holder_.state().commander, "/world");
  session_.world().silence("holder/set_pressure");
  session_.run(kSilent - 0.05);
  EXPECT_EQ(holder_.state().kept, "");
  session_.run(0.1);
  EXPECT_EQ(holder_.state().kept, "the pressure is kept: its commander /world is silent");
  EXPECT_EQ(holder_.state().commander, "");
  expectSaid(holder_.state().kept);
  expectKept();
  holder_.set(kSuction);
  session_.run(0.05);
  EXPECT_EQ(holder_.state().kept, "");
}

TEST_F(HolderTest, TwoCommandersAtOnceAreAFaultThatKeepsThePressure) {
  sensor_msgs::FluidPressure message;
  message.fluid_pressure = kSuction;
  session_.world().repeat("holder/set_pressure", message);
  session_.run(0.5);
  holder_.setBy(other_, 0);
  session_.run(0.1);
  EXPECT_EQ(holder_.state().state, "FAULT");
  const std::string two = "two nodes command the holder: /world and /other; the pressure is kept; allowed after enable";
  EXPECT_EQ(holder_.state().fault, two);
  expectSaid(two);
  expectKept();
  holder_.setBy(other_, 0);
  expectKept(1);
  session_.world().silence("holder/set_pressure");
  holder_.command("enable");
  session_.run(0.05);
  EXPECT_EQ(holder_.state().state, "ENABLED");
  holder_.setBy(other_, -700);
  session_.run(3);
  EXPECT_NEAR(holder_.state().pressure, -700, 1);
  holder_.set(kSuction);  // the other one is silent by now
  session_.run(3);
  expectKept(1);
}

TEST_F(HolderTest, ACellThatDoesNotSealIsFelt) {
  cell_microinjection::HoldingSeal seal;
  seal.resistance = 5e13;
  session_.world().repeat("cell/seal", seal);
  session_.run(3);
  EXPECT_LT(holder_.state().flow, -1e-12);
  EXPECT_GT(holder_.state().pressure, kSuction / 2);
  EXPECT_NEAR(holder_.state().source_pressure, kSuction, 1) << "a regulator";
  const double volume = holder_.state().volume;
  session_.run(1);
  EXPECT_NEAR((holder_.state().volume - volume) / holder_.state().flow, 1, 1e-3);
  for (const double bad : {-1.0, double(NAN)}) {
    seal.resistance = bad;
    session_.world().repeat("cell/seal", seal);
    session_.run(0.1);
    EXPECT_LT(holder_.state().flow, -1e-12) << "the last good one holds";
  }
  session_.call<std_srvs::Trigger>("holder/reset");
  session_.run(0.1);
  EXPECT_NEAR(holder_.state().volume / (0.1 * holder_.state().flow), 1, 0.1);
  EXPECT_NEAR(holder_.state().source_pressure, kSuction, 1) << "a reset lets nothing go";
}

TEST_F(HolderTest, AHolderThatIsToBeEnabledWaits) {
  VirtualSession session{{"holder:=sim", "injection.auto_enable:=false"}};
  HolderWorld holder{session};
  session.add("holder");
  session.run(0.1);
  holder.set(kSuction);
  session.run(0.1);
  EXPECT_EQ(holder.state().state, "DISABLED");
  EXPECT_EQ(holder.state().target, 0);
  holder.command("enable");
  session.run(0.1);
  holder.set(kSuction);
  session.run(0.1);
  EXPECT_EQ(holder.state().target, kSuction);
}

/// Any device whose pressure can be set.
class HolderDevices : public testing::TestWithParam<const char*> {
 protected:
  VirtualSession session_{{std::string("holder:=") + GetParam()}};
  HolderWorld holder_{session_};
};

TEST_P(HolderDevices, AtTheStartThePressureIsLeftAloneAndThenFollows) {
  session_.add("holder", "{diagnostic_period: 0.1, pressure_range: [0, 20.0e3]}");
  ASSERT_TRUE(session_.until([&] { return holder_.states().newest() && holder_.state().fault.empty(); }, 10));
  for (const double pressure : {4000.0, 10000.0}) {
    ASSERT_TRUE(session_.until([&] { return holder_.state().state == "ENABLED"; }, 10));
    holder_.set(pressure);
    EXPECT_TRUE(
        session_.until([&] { return holder_.isKnown() && std::abs(holder_.state().pressure - pressure) < 60; }, 10))
        << holder_.state().pressure << " instead of " << pressure << holder_.state().refusal << holder_.state().fault;
    session_.run(3);
    EXPECT_NEAR(holder_.state().pressure, pressure, 60);
    EXPECT_EQ(holder_.state().fault, "");
  }
}

INSTANTIATE_TEST_SUITE_P(OfConfig, HolderDevices,
                         testing::Values("emulated_arduino", "emulated_voltage", "emulated_femtojet"));

TEST(HolderDevice, AValveCannotHold) {
  VirtualSession session{{"holder:=emulated_relay"}};
  try {
    session.add("holder");
    FAIL();
  } catch (const std::exception& error) {
    EXPECT_NE(std::string(error.what()).find("serial/balance"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("a holder needs the lines that set its pressure"), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
