// The injector does a pulse once, refuses what is old, repeated or out of its range, and shows what flows back.

#include <gtest/gtest.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <cmath>

#include "injector_world.h"

namespace microinjection {
namespace {

constexpr double kPulseTimeout = 0.2, kInjectorStep = 5e-3;  // s, of config/injector.yaml

class InjectorCommands : public testing::Test {
 protected:
  InjectorCommands() {
    session_.add("injector", "{diagnostic_period: 0.1}");
    session_.run(0.2);  // forty times the regulator's time constant
    balance_ = state().pressure;
  }
  const cell_microinjection::InjectorState& state() const { return injector_.state(); }
  /// Volume (m^3) of a pulse.
  double inject(std::uint64_t id) {
    const double before = state().volume;
    injector_.send(id);
    EXPECT_TRUE(session_.until([&] { return state().last_id == id; }, 1));
    session_.run(0.1);
    return state().volume - before;
  }
  void expectRefused(const std::string& why) {
    SCOPED_TRACE(why);
    const unsigned before = state().pulses;
    session_.run(0.2);
    EXPECT_NE(state().refusal.find(why), std::string::npos) << state().refusal;
    const auto* status = session_.diagnostics().of("injector: injector");
    EXPECT_NE(status->level, 0);
    EXPECT_NE(status->message.find(why), std::string::npos) << status->message;
    EXPECT_EQ(state().pulses, before);
  }
  /// Says a pulse and says it again while the time-out lasts. @returns the last stamp
  ros::Time hold(std::uint64_t id) {
    ros::Time said;
    for (int i = 0; i < 4; ++i) {
      said = session_.now();
      injector_.send(id, InjectorWorld::kPressure, 10 * kPulseTimeout, 0, true);
      session_.run(kPulseTimeout - 0.02);
      EXPECT_TRUE(state().busy);
    }
    return said;
  }
  void expectEndsByItself(const ros::Time& said) {
    ASSERT_TRUE(session_.until([&] { return !state().busy; }, 1));
    const double silent = secondsBetween(said, state().header.stamp);
    EXPECT_GT(silent, kPulseTimeout);
    EXPECT_LE(silent, kPulseTimeout + kInjectorStep + 1e-9);
  }

  VirtualSession session_;
  InjectorWorld injector_{session_};
  double balance_;  // Pa
};

TEST_F(InjectorCommands, APulseIsDoneOnce) {
  const unsigned before = state().pulses;
  EXPECT_GT(inject(11), 0);
  for (int i = 0; i < 3; ++i) injector_.send(11);
  injector_.send(12);
  EXPECT_TRUE(session_.until([&] { return state().last_id == 12; }, 1));
  injector_.send(11);
  session_.run(0.5);
  EXPECT_EQ(state().pulses, before + 2);
}

TEST_F(InjectorCommands, WhatIsOldOrOutOfItsRangeIsRefusedWithTheReason) {
  injector_.send(21, InjectorWorld::kPressure, 0.05, 1.0);
  expectRefused("it is stale");
  injector_.send(22, 1e6);
  expectRefused("allowed [-50000, 50000] Pa");
  injector_.send(23, NAN);
  expectRefused("allowed [-50000, 50000] Pa");
  injector_.send(24, InjectorWorld::kPressure, -1);
  expectRefused("allowed [0.001, 60] s");
  injector_.send(0);
  expectRefused("id is 0");
}

TEST_F(InjectorCommands, APulseDuringAPulseIsRefused) {
  injector_.send(31, InjectorWorld::kPressure, 0.5);
  session_.run(0.01);
  EXPECT_TRUE(state().busy);
  injector_.send(32);
  session_.run(0.01);
  EXPECT_NE(state().refusal.find("a pulse is under way"), std::string::npos) << state().refusal;
  ASSERT_TRUE(session_.until([&] { return !state().busy; }, 1));
  session_.run(0.5);
  EXPECT_EQ(state().last_id, 31U);
  EXPECT_EQ(state().pulses, 1U);
}

TEST_F(InjectorCommands, AStopEndsThePulseHoweverOldItIs) {
  const unsigned before = state().pulses;
  session_.run(1);
  std::uint64_t id = 50;
  for (const double age : {0.03, 1.5, -3600.0}) {
    SCOPED_TRACE(age);
    ++id;
    injector_.send(id, InjectorWorld::kPressure, 30);
    session_.run(0.05);
    EXPECT_TRUE(state().busy);
    EXPECT_GT(state().pressure, 0.9 * InjectorWorld::kPressure);
    injector_.stop(age);
    session_.run(kInjectorStep + 2e-3);
    EXPECT_FALSE(state().busy);
    session_.run(0.1);  // twenty times the regulator's time constant
    EXPECT_NEAR(state().pressure, balance_, 1e-3);
    EXPECT_EQ(state().pulses, before);
    EXPECT_NE(state().last_id, id);
  }
  EXPECT_GT(inject(++id), 0);
}

TEST_F(InjectorCommands, AHeldPulseLastsWhileItIsSaidAgain) {
  const unsigned before = state().pulses;
  expectEndsByItself(hold(61));
  session_.run(0.1);
  EXPECT_EQ(state().pulses, before);
  EXPECT_EQ(state().refusal, "");
  EXPECT_NEAR(state().pressure, balance_, 1e-3);
  // One that is not held is done whoever is silent.
  injector_.send(62, InjectorWorld::kPressure, 2 * kPulseTimeout);
  EXPECT_TRUE(session_.until([&] { return state().last_id == 62; }, 1));
}

TEST_F(InjectorCommands, AHeldPulseEndsAlthoughItsStopIsLost) {
  session_.executive().network().alter("/injector/stop", [](const Passage&) { return std::vector<Passage>(); });
  const ros::Time said = hold(71);
  injector_.stop();
  session_.run(0.01);
  EXPECT_TRUE(state().busy) << "the stop was lost";
  expectEndsByItself(said);
}

TEST_F(InjectorCommands, AWrongBalanceFlowsBack) {
  for (const double pressure : {0.0, 2 * balance_}) {
    injector_.setBalance(pressure);
    session_.run(0.1);
    EXPECT_NEAR(state().pressure, pressure, 1e-3);
    EXPECT_GT((pressure > balance_ ? 1 : -1) * state().flow, 0);
  }
  injector_.setBalance(balance_);
  session_.run(0.1);
  EXPECT_NEAR(state().pressure, balance_, 1e-3);
}

TEST_F(InjectorCommands, AClogLetsLessThroughUntilItIsGone) {
  const auto clog = [&](bool data) {
    std_srvs::SetBool::Request request;
    request.data = data;
    EXPECT_TRUE(session_.call<std_srvs::SetBool>("injector/clog", request).success);
  };
  const double clean = inject(41);
  clog(true);
  EXPECT_NEAR(inject(42) / clean, 0.01, 0.001);
  clog(false);
  EXPECT_NEAR(inject(43) / clean, 1, 0.01);
  EXPECT_TRUE(session_.call<std_srvs::Trigger>("injector/reset").success);
  session_.run(0.01);
  EXPECT_NEAR(state().volume, 0, 1e-3 * clean);
}

}  // namespace
}  // namespace microinjection
