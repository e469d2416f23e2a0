// Injections in which suction breaks the membrane.

#include <string>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

class SuctionInjectionTest : public InjectionFixture {
 protected:
  SuctionInjectionTest() {
    config_.goal.break_by = BreakBy::kSuction;
    config_.goal.suction.dent = 5e-6;
    config_.goal.suction.largest = 1000;
    config_.goal.suction.time = 0.2;
    rig_.puncture_force = 2e-6;
  }
};

TEST_F(SuctionInjectionTest, BreaksTheMembraneInAShallowDentAndInjects) {
  rig_.break_suction = 400;
  enable();
  rig_.run(controller_);
  const InjectionResult& result = controller_.result();
  EXPECT_EQ(result.outcome, InjectionOutcome::kInjected) << result.reason;
  EXPECT_EQ(result.punctures, 1);
  EXPECT_NEAR(result.break_suction, 400, 25);
  EXPECT_NEAR(*result.puncture_force, rig_.stiffness * 5e-6, 50e-9);
  EXPECT_LT(rig_.largest_force, 0.7e-6) << "the needle has not gone deeper to break it";
  EXPECT_GT(rig_.lowest_pressure, -420) << "the suction ends with the break";
}

/// The force's readings come one a step.
TEST_F(SuctionInjectionTest, ASlowLoopWaitsForItsWitness) {
  for (const double rate : {100, 200, 500, 2000}) {
    rig_ = SpringRig();
    rig_.period = 1 / rate;
    rig_.break_suction = 400;
    enable();
    rig_.run(controller_);
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << rate << ": " << controller_.result().reason;
    EXPECT_NEAR(controller_.result().break_suction, 400, 25 + 40 * 500 / rate)
        << rate << ": 40 readings, meanwhile the suction rises";
  }
}

TEST_F(SuctionInjectionTest, AMembraneThatWithstandsItIsHeldOrBrokenByForce) {
  for (const BreakBy by : {BreakBy::kSuction, BreakBy::kSuctionThenForce}) {
    rig_ = SpringRig();
    config_.goal.break_by = by;
    enable();
    rig_.run(controller_);
    EXPECT_NEAR(rig_.lowest_pressure, -1000, 1);
    EXPECT_FALSE(controller_.pulse());
    const bool goes_on = by == BreakBy::kSuctionThenForce;
    EXPECT_EQ(controller_.result().outcome, goes_on ? InjectionOutcome::kInjected : InjectionOutcome::kNotPunctured);
    EXPECT_EQ(controller_.result().break_suction, 0);
    if (!goes_on) EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  }
}

TEST_F(SuctionInjectionTest, SuctionFollowsWhereTheForceHasNotBrokenIt) {
  config_.goal.break_by = BreakBy::kForceThenSuction;
  config_.goal.depth = 15e-6;  // 1.5 uN
  rig_.break_suction = 400;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
  EXPECT_NEAR(controller_.result().break_suction, 400, 25);
  EXPECT_GT(rig_.largest_force, 1.4e-6);
}

/// The first membrane by force, since suction is for the last one.
TEST_F(SuctionInjectionTest, OnlyTheLastMembraneIsDrawnIn) {
  config_.goal.layers = 2;
  rig_.puncture_force = 1e-6;
  rig_.second_force = 5e-6;
  rig_.break_suction = 1;  // of the first: it does not come to that
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().punctures, 1);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotPunctured);
  EXPECT_GT(rig_.largest_force, 0.98e-6);
  EXPECT_NEAR(rig_.lowest_pressure, -1000, 1);
}

TEST_F(SuctionInjectionTest, NoSuctionWhileItIsPaused) {
  rig_.break_suction = 700;
  enable();
  ASSERT_TRUE(reach(InjectionState::kAspirate));
  while (!controller_.pulse()) rig_.step(controller_);
  steps(500);
  EXPECT_EQ(controller_.command("pause"), "");
  EXPECT_FALSE(controller_.pulse());
  steps(100);
  EXPECT_FALSE(controller_.pulse());
  EXPECT_EQ(controller_.command("resume"), "");
  while (!controller_.pulse()) rig_.step(controller_);
  EXPECT_GT(controller_.pulse()->pressure, -10) << "it grows from nothing again";
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

/// The pause comes between the alarm and its confirmation: the membrane is open, and must not be drawn in again.
TEST_F(SuctionInjectionTest, APauseDoesNotForgetABreak) {
  rig_.break_suction = 400;
  enable();
  ASSERT_TRUE(reach(InjectionState::kAspirate));
  while (!rig_.punctured) rig_.step(controller_);
  while (controller_.pulse()) rig_.step(controller_);
  EXPECT_EQ(controller_.command("pause"), "");
  steps(300);
  EXPECT_EQ(controller_.command("resume"), "");
  while (controller_.injection() == InjectionState::kAspirate) {
    EXPECT_FALSE(controller_.pulse());
    rig_.step(controller_);
  }
  EXPECT_EQ(controller_.injection(), InjectionState::kPunctured);
}

/// As one on a serial line, which cannot change the pressure of a pulse under way.
TEST_F(SuctionInjectionTest, AnInjectorThatDoesNotDrawIsSaid) {
  rig_.obeys = false;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjectorTimeOut);
  EXPECT_EQ(controller_.result().reason, "the injector does not draw as it is told");
  EXPECT_FALSE(controller_.pulse());
}

TEST_F(SuctionInjectionTest, WhatIsLostEndsTheSuctionAndHoldsTheNeedle) {
  const struct {
    const char* what;
    bool SpringRig::*tells;
    InjectionOutcome outcome;
  } lost[] = {{"force", &SpringRig::force_tells, InjectionOutcome::kGuard},
              {"needle", &SpringRig::needle_tells, InjectionOutcome::kGuard},
              {"injector", &SpringRig::injector_tells, InjectionOutcome::kInjectorTimeOut}};
  for (const auto& each : lost) {
    rig_ = SpringRig();
    enable();
    ASSERT_TRUE(reach(InjectionState::kAspirate)) << each.what;
    while (!controller_.pulse()) rig_.step(controller_);
    rig_.*each.tells = false;
    steps(300);
    EXPECT_FALSE(controller_.pulse()) << each.what;
    EXPECT_EQ(controller_.result().outcome, each.outcome) << each.what << ": " << controller_.result().reason;
    EXPECT_EQ(controller_.state(), OperatingState::kPaused) << each.what;
    rig_.*each.tells = true;
    EXPECT_EQ(controller_.command("withdraw"), "") << each.what;
    expectSafe(each.what);
  }
}

TEST_F(SuctionInjectionTest, StepByStepTheOperatorBeginsIt) {
  config_.mode = "semi_automatic";
  rig_.break_suction = 400;
  enable();
  EXPECT_EQ(controller_.command("approach"), "");
  ASSERT_TRUE(reach(InjectionState::kContact));
  steps(200);
  EXPECT_NE(controller_.command("aspirate"), "");
  EXPECT_EQ(controller_.command("indent"), "");
  steps(3000);
  EXPECT_EQ(controller_.injection(), InjectionState::kIndent);
  EXPECT_TRUE(controller_.awaitsCommand());
  EXPECT_FALSE(controller_.pulse());
  EXPECT_EQ(controller_.command("aspirate"), "");
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  EXPECT_NEAR(controller_.result().break_suction, 400, 25);
}

}  // namespace
}  // namespace microinjection
