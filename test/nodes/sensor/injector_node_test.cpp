// Any injector as a session has it: its file over config/injector.yaml, and the device at the other end of the line
// emulated as manuals have it. test/hardware/injector/injector_contract_test.cpp asks more of the drivers.

#include <gtest/gtest.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <cstdio>

#include "injector_world.h"

namespace microinjection {
namespace {

constexpr double kAtmosphere = 101300;  // Pa

class InjectorNodeTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    session_.add("injector", "{diagnostic_period: 0.1}");
    ASSERT_TRUE(session_.until([&] { return injector_.states().newest() && state().fault.empty() && !state().busy; }));
    session_.run(0.2);  // forty times the regulator's time constant
    balance_ = state().pressure;
  }
  const cell_microinjection::InjectorState& state() const { return injector_.state(); }
  /// Whether its balance pressure can be set from here.
  bool balances() const { return GetParam() != "emulated_relay"; }

  void expectSet(double pressure) {
    injector_.setBalance(pressure);
    EXPECT_TRUE(session_.until([&] { return std::abs(state().pressure - pressure) < 1e-3; }, 5))
        << pressure << " Pa; " << state().refusal << state().fault;
    EXPECT_EQ(state().refusal, "");
  }
  void expectRefused(double pressure) {
    char why[100];
    std::snprintf(why, sizeof(why), "balance pressure = %g Pa, allowed [%g, %g] Pa", pressure, range_[0], range_[1]);
    injector_.setBalance(pressure);
    session_.run(0.5);
    EXPECT_NE(state().refusal.find(why), std::string::npos) << state().refusal << " instead of " << why;
    EXPECT_NEAR(state().pressure, balance_, 1e-3);
  }

  VirtualSession session_{{"injector:=" + GetParam()}};
  InjectorWorld injector_{session_};
  const std::vector<double> range_ = session_.parameters("injector")["pressure_range"].as<std::vector<double>>();  // Pa
  double balance_ = 0;                                                                                             // Pa
};

TEST_P(InjectorNodeTest, APulseIsDoneOnceAndAsLongAsAsked) {
  constexpr double kDuration = 0.5;  // s
  const unsigned before = state().pulses;
  injector_.send(5, InjectorWorld::kPressure, kDuration);
  ASSERT_TRUE(session_.until([&] { return state().pressure > 0.9 * InjectorWorld::kPressure; }, 5));
  const ros::Time begun = state().header.stamp;
  ASSERT_TRUE(session_.until([&] { return state().pressure < 0.9 * InjectorWorld::kPressure; }, 5));
  const double took = secondsBetween(begun, state().header.stamp);
  EXPECT_GE(took, kDuration - 0.015) << "a pulse begins before 0.9 of its pressure are there";
  EXPECT_LE(took, kDuration + 0.035) << "one that is timed here lasts a reply at 9600 baud and two steps longer";
  EXPECT_TRUE(session_.until([&] { return state().last_id == 5; }, 1))
      << "some devices are asked first whether it was that";
  session_.run(1);
  EXPECT_EQ(state().pulses, before + 1);
  EXPECT_EQ(state().fault, "");
  EXPECT_NEAR(state().pressure, balance_, 1e-3);
}

TEST_P(InjectorNodeTest, WhatItCannotDoIsRefused) {
  injector_.send(5, 1e9, 0.5);
  session_.run(1);
  EXPECT_NE(state().refusal.find("pulse pressure = 1e+09 Pa"), std::string::npos) << state().refusal;
  EXPECT_EQ(state().pulses, 0U);
  EXPECT_NEAR(state().pressure, balance_, 1e-3);
}

TEST_P(InjectorNodeTest, AnotherBalancePressureIsSetOrRefused) {
  if (!balances()) {
    injector_.setBalance(balance_ + 200);
    session_.run(0.1);
    EXPECT_NE(state().refusal.find("set by hand"), std::string::npos) << state().refusal;
    return;
  }
  expectSet(balance_ + 200);
  session_.run(2);
  EXPECT_EQ(state().fault, "");
  EXPECT_NEAR(state().pressure, balance_ + 200, 1e-3);
  expectSet(balance_);
}

/// The message is made for absolute pressures. One is beyond the limits of most; a FemtoJet's are wider.
TEST_P(InjectorNodeTest, TheBalanceIsGaugeAndReachesBothEnds) {
  const double lowest = range_[0], highest = range_[1];
  for (const double beyond : {lowest - 100, highest + 1000, kAtmosphere + highest}) expectRefused(beyond);
  if (!balances()) return;
  const double absolute = kAtmosphere + 100 * std::round(balance_ / 100);
  EXPECT_EQ(absolute > highest, GetParam() != "emulated_femtojet");
  if (absolute > highest) expectRefused(absolute);
  expectSet(lowest);
  expectSet(highest);
  if (absolute <= highest) expectSet(absolute);  // the number as it is: nothing takes the atmosphere's off
  expectSet(balance_);
  EXPECT_EQ(state().fault, "");
}

TEST_P(InjectorNodeTest, ItIsAsGoodAfterAReset) {
  EXPECT_TRUE(session_.call<std_srvs::Trigger>("injector/reset").success);
  injector_.send(5, InjectorWorld::kPressure, 0.5);
  EXPECT_TRUE(session_.until([&] { return state().last_id == 5; }, 5)) << state().refusal << state().fault;
}

INSTANTIATE_TEST_SUITE_P(Injectors, InjectorNodeTest,
                         testing::Values("simulated", "emulated_arduino", "emulated_femtojet", "emulated_relay",
                                         "emulated_voltage"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace microinjection
