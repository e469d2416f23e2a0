// Injections whose cell the holding pipette takes first.

#include "operation/control/holding.h"

#include <cmath>
#include <string>
#include <utility>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

constexpr double kHoldSuction = 1500;  // Pa

class HoldingInjectionTest : public InjectionFixture {
 protected:
  HoldingInjectionTest() {
    config_.holder = true;
    config_.goal.holding.suction = kHoldSuction;
    config_.goal.holding.time = 2;
    config_.goal.holding.release = true;
  }
  bool waitsIn(InjectionState state) {
    for (int i = 0; i < 20000 && !(controller_.injection() == state && controller_.awaitsCommand()); ++i)
      rig_.step(controller_);
    return controller_.awaitsCommand();
  }
  /// Pa, gauge.
  double asked() const { return controller_.holderCommand() ? controller_.holderCommand()->pressure : NAN; }
};

TEST_F(HoldingInjectionTest, TakesTheCellInjectsAndLetsItGo) {
  for (const bool seen : {false, true}) {
    rig_ = SpringRig();
    rig_.somebody_sees = seen;
    enable();
    EXPECT_EQ(controller_.injection(), InjectionState::kHold);
    const Eigen::Vector3d start = rig_.tip;
    ASSERT_TRUE(reach(InjectionState::kApproach));
    EXPECT_EQ(rig_.tip, start) << "the needle waits until the cell is held";
    EXPECT_NEAR(rig_.holder_pressure, -kHoldSuction, 0.11 * kHoldSuction);
    ASSERT_TRUE(reach(InjectionState::kRelease));
    EXPECT_LT((rig_.tip - start).norm(), 0.3e-6) << "the needle is out first";
    EXPECT_LT(rig_.holder_pressure, -0.99 * kHoldSuction);
    rig_.run(controller_);
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
    EXPECT_EQ(controller_.result().reason, "");
    EXPECT_EQ(asked(), 0) << "it does not blow for ever";
    EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  }
}

TEST_F(HoldingInjectionTest, ACellThatIsNotThereIsNotInjected) {
  rig_.cell_is_there = false;
  enable();
  const Eigen::Vector3d start = rig_.tip;
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotHeld);
  EXPECT_NE(controller_.result().reason.find("does not close the mouth"), std::string::npos);
  EXPECT_NEAR(controller_.result().duration, 2, 0.01);
  EXPECT_EQ(rig_.tip, start);
  EXPECT_EQ(asked(), -kHoldSuction) << "kept, as by any fault";
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  EXPECT_NE(controller_.notice().find("does not close the mouth"), std::string::npos) << controller_.notice();
  // The same suction is asked for again.
  const int number = controller_.holderCommand()->number;
  rig_.cell_is_there = true;
  EXPECT_EQ(controller_.start(config_.goal), "");
  EXPECT_EQ(controller_.holderCommand()->number, number + 1);
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

TEST_F(HoldingInjectionTest, NeedsNoForceWhileTheNeedleWaits) {
  enable();
  rig_.force_tells = false;
  steps(600);
  EXPECT_EQ(controller_.injection(), InjectionState::kApproach);
  rig_.force_tells = true;
  ASSERT_TRUE(reach(InjectionState::kWithdraw));
  rig_.force_tells = false;
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
  EXPECT_EQ(asked(), 0);
}

/// What ends an injection early leaves the cell where it is.
TEST_F(HoldingInjectionTest, ACellThatIsNotDoneIsNotLetGo) {
  for (const InjectionState state : {InjectionState::kHold, InjectionState::kApproach, InjectionState::kIndent}) {
    rig_ = SpringRig();
    enable();
    ASSERT_TRUE(reach(state)) << toText(state);
    EXPECT_EQ(controller_.withdraw(), "") << toText(state);
    rig_.run(controller_);
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kPreempted) << toText(state);
    EXPECT_EQ(controller_.result().reason, "the cell is still held");
    EXPECT_EQ(asked(), -kHoldSuction) << toText(state);
    EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  }
}

TEST_F(HoldingInjectionTest, HoldAndReleaseHaveAWayOut) {
  config_.mode = "semi_automatic";
  config_.goal.puncture = false;
  config_.goal.depth = 5e-6;
  for (const char* word : {"withdraw", "home", "disable", "unhome"}) {
    for (const InjectionState state : {InjectionState::kHold, InjectionState::kRelease}) {
      rig_ = SpringRig();
      enable();
      ASSERT_EQ(controller_.command("hold"), "");
      if (state == InjectionState::kRelease) {
        const std::pair<InjectionState, const char*> way[] = {{InjectionState::kHold, "approach"},
                                                              {InjectionState::kContact, "indent"},
                                                              {InjectionState::kIndent, "withdraw"}};
        for (const auto& [from, command] : way) {
          ASSERT_TRUE(waitsIn(from)) << toText(from);
          ASSERT_EQ(controller_.command(command), "") << command;
        }
      }
      ASSERT_TRUE(reach(state)) << toText(state) << ' ' << word;
      steps(100);
      EXPECT_EQ(controller_.command(word), "") << toText(state) << ' ' << word;
      rig_.run(controller_, 5000);
      steps(100);
      EXPECT_FALSE(controller_.running()) << toText(state) << ' ' << word;
      EXPECT_EQ(asked(), -kHoldSuction) << toText(state) << ' ' << word;
    }
  }
}

TEST_F(HoldingInjectionTest, APausedHoldGoesOn) {
  enable();
  steps(20);
  EXPECT_EQ(controller_.command("pause"), "");
  steps(600);
  EXPECT_EQ(controller_.injection(), InjectionState::kHold);
  EXPECT_EQ(controller_.command("resume"), "");
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

TEST_F(HoldingInjectionTest, NoInjectionBeginsWhileTheCellIsLetGo) {
  config_.start_when_enabled = false;
  enable();
  EXPECT_EQ(controller_.command("release"), "");
  steps(10);
  config_.goal.holding = {};
  EXPECT_EQ(controller_.start(config_.goal), "the holding pipette lets the cell go");
  steps(1200);
  EXPECT_EQ(controller_.start(config_.goal), "");
}

TEST_F(HoldingInjectionTest, ACellThatSticksToTheMouthIsNotLetGo) {
  rig_.somebody_sees = true;
  rig_.sticks = true;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
  EXPECT_EQ(controller_.result().reason, "the cell was not let go: it is still held");
}

TEST_F(HoldingInjectionTest, APressureOfNothingLetsGo) {
  config_.goal.holding.release_pressure = 0;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().reason, "");
}

TEST_F(HoldingInjectionTest, AHolderThatDoesNotTellHoldsNothing) {
  rig_.holder_tells = false;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotHeld);
  EXPECT_NE(controller_.result().reason.find("no valid state of the holder"), std::string::npos);
}

TEST_F(HoldingInjectionTest, ASealThatOpensStopsTheNeedleInEachState) {
  for (const InjectionState state : {InjectionState::kApproach, InjectionState::kContact, InjectionState::kIndent,
                                     InjectionState::kPunctured, InjectionState::kInject}) {
    for (const bool seen : {false, true}) {
      rig_ = SpringRig();
      rig_.somebody_sees = seen;
      enable();
      ASSERT_TRUE(reach(state)) << toText(state);
      rig_.cell_is_there = false;
      steps(2);
      EXPECT_EQ(controller_.state(), OperatingState::kPaused) << toText(state);
      EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard) << toText(state);
      EXPECT_NE(controller_.result().reason.find("does not hold the cell"), std::string::npos)
          << controller_.result().reason;
      EXPECT_EQ(controller_.command("withdraw"), "");
      expectSafe(toText(state));
    }
  }
}

TEST_F(HoldingInjectionTest, AHolderThatFallsSilentDoesNotStopTheNeedle) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kIndent));
  rig_.holder_tells = false;  // its pressure stays, whatever happens to it
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
  EXPECT_EQ(controller_.result().reason, "the cell was not let go: no valid state of the holder");
}

TEST_F(HoldingInjectionTest, StepByStepItWaitsForEachWord) {
  config_.mode = "semi_automatic";
  config_.goal.puncture = false;
  config_.goal.depth = 5e-6;
  enable();
  EXPECT_EQ(controller_.command("hold"), "");
  steps(600);
  EXPECT_TRUE(controller_.awaitsCommand());
  EXPECT_EQ(controller_.injection(), InjectionState::kHold);
  EXPECT_NE(controller_.command("release"), "") << "in idle only";
  EXPECT_EQ(controller_.command("approach"), "");
  ASSERT_TRUE(waitsIn(InjectionState::kContact));
  EXPECT_EQ(controller_.command("indent"), "");
  ASSERT_TRUE(waitsIn(InjectionState::kIndent));
  EXPECT_EQ(controller_.command("withdraw"), "");
  ASSERT_TRUE(reach(InjectionState::kRelease));
  steps(100);
  EXPECT_TRUE(controller_.awaitsCommand());
  EXPECT_EQ(asked(), -kHoldSuction) << "not before the word";
  EXPECT_EQ(controller_.command("release"), "");
  rig_.run(controller_);
  EXPECT_EQ(asked(), 0);
}

TEST_F(HoldingInjectionTest, ByHandThePressureAloneIsCommanded) {
  config_.mode = "manual";
  enable();
  EXPECT_EQ(controller_.command("hold"), "");
  steps(600);
  EXPECT_EQ(controller_.holding().phase(), Holding::Phase::kHeld);
  EXPECT_EQ(controller_.notice(), "");
  rig_.cell_is_there = false;
  steps(1);
  EXPECT_NE(controller_.notice().find("does not hold the cell"), std::string::npos) << controller_.notice();
  EXPECT_EQ(controller_.command("release"), "");
  steps(3000);
  EXPECT_EQ(asked(), 0);
}

TEST_F(HoldingInjectionTest, WithoutAHolderTheGoalIsRefused) {
  config_.holder = false;
  config_.start_when_enabled = false;
  enable();
  EXPECT_NE(controller_.start(config_.goal).find("no holder is there"), std::string::npos);
  EXPECT_EQ(controller_.command("hold"), "there is no holder");
  EXPECT_EQ(controller_.command("release"), "there is no holder");
}

TEST_F(HoldingInjectionTest, NumbersBeyondTheirLimitsAreNamed) {
  config_.goal.holding.suction = NAN;
  config_.goal.holding.release_pressure = 1e6;
  config_.goal.holding.release_time = 3;
  EXPECT_NE(config_.goal.problems().find("holding/release_time must be below holding/time"), std::string::npos);
  EXPECT_NE(config_.goal.problems().find("holding/suction"), std::string::npos);
  EXPECT_NE(config_.goal.problems().find("holding/release_pressure = 1e+06 Pa, allowed [0, 10000] Pa"),
            std::string::npos)
      << config_.goal.problems();
}

}  // namespace
}  // namespace microinjection
