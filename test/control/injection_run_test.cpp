#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "control/spring_rig.h"

namespace microinjection {
namespace {

class InjectionRunTest : public testing::Test {
 protected:
  InjectionRunTest() {
    config_.mode = "automatic";
    config_.goal.depth = 30e-6;
    config_.goal.pulse.duration = 0.3;
    config_.motion.stop_time = 5e-3;
  }

  void enable() {
    controller_ = InjectionController(config_);
    controller_.command("enable");
    rig_.step(controller_);
  }

  /// Steps until that state; false when it does not come.
  bool reach(InjectionState state) {
    for (int i = 0; i < 100000; ++i) {
      if (controller_.injection() == state) return true;
      rig_.step(controller_);
    }
    return false;
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) rig_.step(controller_);
  }

  /// The needle does not move any more, or is out of the cell.
  void expectSafe(const std::string& where) {
    rig_.run(controller_);
    steps(200);
    const Eigen::Vector3d before = rig_.tip;
    steps(100);
    EXPECT_LT((rig_.tip - before).norm(), 1e-9) << where;
    EXPECT_FALSE(controller_.pulse()) << where;
    EXPECT_FALSE(controller_.running()) << where;
  }

  InjectionControllerConfig config_;
  InjectionController controller_{config_};
  SpringRig rig_;
};

TEST_F(InjectionRunTest, WholeInjection) {
  enable();
  std::vector<std::string> states;
  const Eigen::Vector3d start = rig_.tip;
  while (controller_.busy() && states.size() < 100) {
    rig_.step(controller_);
    if (states.empty() || states.back() != toText(controller_.injection()))
      states.push_back(toText(controller_.injection()));
  }
  EXPECT_EQ(states, (std::vector<std::string>{"approach", "contact", "indent", "punctured", "inject", "punctured",
                                              "withdraw", "idle"}));
  const InjectionResult& result = controller_.result();
  EXPECT_EQ(result.outcome, InjectionOutcome::kInjected) << result.reason;
  EXPECT_EQ(result.punctures, 1);
  EXPECT_NEAR(result.volume, 0.2e-15, 2e-18);
  EXPECT_NEAR(*result.puncture_force, rig_.puncture_force, 0.1 * rig_.puncture_force);
  EXPECT_NEAR(result.peak_force, rig_.puncture_force, 5 * rig_.noise);
  // 10 um deep the membrane fails; touched a little below the surface; margin, and what is gone on until it is felt.
  EXPECT_GT(rig_.deepest, 10e-6 + config_.goal.margin - 0.5e-6);
  EXPECT_LT(rig_.deepest, 10e-6 + config_.goal.margin + config_.motion.overshoot);
  EXPECT_NEAR(result.max_depth, rig_.deepest, 1e-6);
  steps(100);
  EXPECT_LT((rig_.tip - start).norm(), 1e-9);
}

TEST_F(InjectionRunTest, SamePlaceAndOutcomeWithoutNoise) {
  rig_.noise = 0;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

TEST_F(InjectionRunTest, GoesThroughOneLayerAfterTheOther) {
  rig_.second_force = 0.5e-6;
  config_.goal.layers = 2;
  enable();
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  EXPECT_FALSE(rig_.second_punctured);
  ASSERT_TRUE(reach(InjectionState::kInject));
  EXPECT_TRUE(rig_.second_punctured);
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
  EXPECT_EQ(controller_.result().punctures, 2);
  EXPECT_NEAR(*controller_.result().puncture_force, 0.3e-6 + 0.5e-6, 0.1e-6);
}

TEST_F(InjectionRunTest, NeverFasterThanTheRig) {
  enable();
  controller_.limitSpeed(8e-6);
  double fastest = 0;
  while (controller_.busy()) {
    const Eigen::Vector3d before = *rig_.setpoint;
    rig_.step(controller_);
    fastest = std::max(fastest, (*rig_.setpoint - before).norm() / SpringRig::kStep);
  }
  EXPECT_NEAR(fastest, 8e-6, 1e-9);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << controller_.result().reason;
}

TEST_F(InjectionRunTest, NoCellIsNoContact) {
  rig_.surface = -1;
  enable();
  const Eigen::Vector3d start = rig_.tip;
  rig_.run(controller_);
  steps(100);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNoContact);
  EXPECT_LT((rig_.tip - start).norm(), 1e-9);
}

TEST_F(InjectionRunTest, ForceAcrossThePipetteIsNoContact) {
  enable();
  for (int i = 0; i < 1000; ++i) {
    rig_.sense(controller_);
    rig_.input.force->x() = 1e-6;
    rig_.setpoint = controller_.step(rig_.input, SpringRig::kStep);
    rig_.move();
    if (rig_.tip.z() < rig_.surface) break;
    ASSERT_EQ(controller_.injection(), InjectionState::kApproach);
  }
}

TEST_F(InjectionRunTest, MembraneThatHoldsEndsHeldAtDepth) {
  rig_.puncture_force = 1;
  enable();
  rig_.run(controller_);
  steps(100);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotPunctured);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_EQ(controller_.injection(), InjectionState::kIndent);
  EXPECT_NEAR(rig_.depth(), config_.goal.depth, 1e-6);
  EXPECT_EQ(controller_.command("resume"), "");
  steps(100);
  EXPECT_NEAR(rig_.depth(), config_.goal.depth, 1e-6) << "what is over does not go on";
  EXPECT_EQ(controller_.command("withdraw"), "");
  rig_.run(controller_);
  steps(20);
  EXPECT_EQ(rig_.depth(), 0);
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotPunctured) << "is not rewritten";
}

TEST_F(InjectionRunTest, IndentsOnlyWhereNoPunctureIsAskedFor) {
  config_.goal.puncture = false;
  config_.goal.depth = 8e-6;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kIndented);
  EXPECT_NEAR(controller_.result().max_depth, 8e-6, 0.1e-6);
  EXPECT_EQ(controller_.result().punctures, 0);
}

TEST_F(InjectionRunTest, GuardsHoldTheNeedle) {
  config_.guards.force_limit = 0.8e-6;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("N, allowed 8e-07 N"), std::string::npos) << controller_.result().reason;
  expectSafe("force");
  EXPECT_LT(rig_.largest_force, 0.85e-6);
  EXPECT_FALSE(rig_.punctured);

  rig_ = SpringRig();
  config_.guards.force_limit = 15e-6;
  config_.guards.depth_limit = 5e-6;
  rig_.puncture_force = 1;
  enable();
  rig_.run(controller_);
  expectSafe("depth");
  EXPECT_LT(rig_.deepest, 5e-6 + 0.7e-6);

  rig_ = SpringRig();
  config_.guards.depth_limit = 50e-6;
  config_.guards.time_limit = 0.1;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("time in state approach"), std::string::npos)
      << controller_.result().reason;
  expectSafe("time");
}

TEST_F(InjectionRunTest, InjectorThatIsDeadOrBrokenIsNotWaitedForLong) {
  rig_.injector_works = false;
  enable();
  ASSERT_TRUE(reach(InjectionState::kInject));
  rig_.run(controller_, 1400);
  EXPECT_NE(controller_.injection(), InjectionState::kInject);
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjectorTimeOut);
  EXPECT_EQ(rig_.depth(), 0);
}

TEST_F(InjectionRunTest, InjectorThatIsSilentLeavesTheNeedleWhereItIs) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kInject));
  rig_.injector_tells = false;
  rig_.run(controller_, 1400);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjectorTimeOut);
  expectSafe("silent injector");
  EXPECT_GT(rig_.depth(), 0);
  EXPECT_EQ(controller_.command("withdraw"), "");
}

TEST_F(InjectionRunTest, NoPulseGoesOnWhereNeedleOrForceIsNotKnown) {
  for (const bool needle : {true, false}) {
    rig_ = SpringRig();
    enable();
    ASSERT_TRUE(reach(InjectionState::kInject));
    steps(20);
    ASSERT_TRUE(controller_.pulse());
    (needle ? rig_.needle_tells : rig_.force_tells) = false;
    rig_.step(controller_);
    EXPECT_FALSE(controller_.pulse()) << needle;
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard) << needle;
    rig_.needle_tells = rig_.force_tells = true;
    expectSafe("known again");
    EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  }
}

TEST_F(InjectionRunTest, VolumeEndsThePulse) {
  config_.goal.pulse.volume = 0.05e-15;
  enable();
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
  EXPECT_NEAR(rig_.volume, 0.05e-15, 3e-18);
}

TEST_F(InjectionRunTest, PreemptedAtAnyMomentEndsOut) {
  enable();
  int total = 0;
  for (; controller_.busy(); ++total) rig_.step(controller_);
  std::set<std::string> states;
  for (int moment = 0; moment < total; moment += 17) {
    rig_ = SpringRig();
    enable();
    steps(moment);
    if (!controller_.running()) break;
    states.insert(toText(controller_.injection()));
    ASSERT_EQ(controller_.command("withdraw"), "") << moment;
    const double deep = rig_.deepest = rig_.depth();
    rig_.run(controller_);
    steps(100);
    const auto outcome = controller_.result().outcome;
    EXPECT_TRUE(outcome == InjectionOutcome::kPreempted || outcome == InjectionOutcome::kInjected) << moment;
    EXPECT_EQ(rig_.depth(), 0) << moment;
    EXPECT_EQ(controller_.injection(), InjectionState::kIdle) << moment;
    EXPECT_LT(rig_.deepest, deep + 1.5e-6) << moment << ": what the lag holds";
    EXPECT_FALSE(controller_.pulse());
  }
  EXPECT_EQ(states.size(), 6u) << "not every state was met";
}

TEST_F(InjectionRunTest, PausedAtAnyMomentHoldsAndGoesOn) {
  enable();
  int total = 0;
  for (; controller_.busy(); ++total) rig_.step(controller_);
  for (int moment = 0; moment < total; moment += 97) {
    rig_ = SpringRig();
    enable();
    steps(moment);
    if (!controller_.running()) break;
    const std::string where = std::string(toText(controller_.injection())) + " " + std::to_string(moment);
    ASSERT_EQ(controller_.command("pause"), "");
    steps(30);
    const Eigen::Vector3d held = rig_.tip;
    steps(100);
    EXPECT_LT((rig_.tip - held).norm(), 1e-9) << where;
    controller_.command("resume");
    rig_.run(controller_);
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << where << controller_.result().reason;
  }
}

/// Each input in turn, absent or not a number, in each state.
TEST_F(InjectionRunTest, UntrustedInputsHoldInEachState) {
  const Eigen::Vector3d nan = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  using State = InjectionState;
  for (const State state :
       {State::kApproach, State::kContact, State::kIndent, State::kPunctured, State::kInject, State::kWithdraw}) {
    for (int which = 0; which < 4; ++which) {
      rig_ = SpringRig();
      enable();
      ASSERT_TRUE(reach(state));
      steps(5);
      if (controller_.injection() != state) continue;
      const bool needle = which < 2;
      std::optional<Eigen::Vector3d> setpoint = rig_.setpoint;
      const Eigen::Vector3d held = *setpoint;
      for (int i = 0; i < 100; ++i) {
        rig_.sense(controller_);
        auto& input = needle ? rig_.input.needle : rig_.input.force;
        if (which % 2 == 0) input.reset();
        if (which % 2 == 1) input = nan;
        setpoint = controller_.step(rig_.input, SpringRig::kStep);
        ASSERT_TRUE(setpoint && setpoint->allFinite());
        rig_.setpoint = setpoint;
        rig_.move();
      }
      const std::string where = std::string(toText(state)) + ", " + std::to_string(which);
      if (needle || state != State::kWithdraw) {
        EXPECT_LT((*setpoint - held).norm(), 1e-12) << where;
      } else {
        EXPECT_GT(setpoint->z(), held.z() + 1e-6) << "no force is needed to withdraw";
      }
      rig_.run(controller_);
      const auto outcome = controller_.result().outcome;
      const bool ends = state == State::kInject || (!needle && state == State::kIndent);
      EXPECT_EQ(outcome, ends ? InjectionOutcome::kGuard : InjectionOutcome::kInjected) << where;
      expectSafe(where);
    }
  }
}

TEST_F(InjectionRunTest, DisabledAtAnyMomentSaysNothing) {
  for (int moment = 1; moment < 2000; moment += 111) {
    rig_ = SpringRig();
    enable();
    steps(moment);
    controller_.command("disable");
    steps(1);
    EXPECT_FALSE(rig_.setpoint);
    EXPECT_FALSE(controller_.pulse());
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kDisabled);
    EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  }
}

TEST_F(InjectionRunTest, SemiAutomaticWaitsForTheOperatorsWord) {
  config_.mode = "semi_automatic";
  enable();
  steps(1000);
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  EXPECT_NE(controller_.command("indent"), "");
  EXPECT_EQ(controller_.command("approach"), "");
  EXPECT_NE(controller_.command("approach"), "");
  ASSERT_TRUE(reach(InjectionState::kContact));
  steps(5000);
  ASSERT_EQ(controller_.injection(), InjectionState::kContact);
  EXPECT_TRUE(controller_.waits());
  const double before = rig_.depth();
  EXPECT_NE(controller_.command("inject"), "");
  EXPECT_EQ(controller_.command("indent"), "");
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  EXPECT_GT(rig_.depth(), before + 5e-6);
  steps(5000);
  ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
  EXPECT_EQ(controller_.command("inject"), "");
  ASSERT_TRUE(reach(InjectionState::kInject));
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  steps(5000);
  ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
  EXPECT_NE(controller_.command("inject"), "") << "once";
  EXPECT_EQ(controller_.command("withdraw"), "");
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
  EXPECT_EQ(controller_.command("approach"), "") << "again";
}

TEST_F(InjectionRunTest, CommandsOfAnotherModeAreRefused) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kContact));
  EXPECT_NE(controller_.command("indent"), "");
  EXPECT_NE(controller_.start(config_.goal), "");
  config_.mode = "manual";
  enable();
  for (const char* command : {"approach", "indent", "withdraw", "inject"}) {
    EXPECT_NE(controller_.command(command), "") << command;
  }
}

TEST_F(InjectionRunTest, GoalsThatAreUnsoundAreRefused) {
  config_.start_when_enabled = false;
  enable();
  InjectionGoal goal = config_.goal;
  goal.depth = 1.1 * config_.guards.depth_limit;
  EXPECT_NE(controller_.start(goal), "");
  goal.depth = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(controller_.start(goal).find("depth = nan"), std::string::npos);
  goal = config_.goal;
  goal.layers = 0;
  EXPECT_NE(controller_.start(goal), "");
  EXPECT_EQ(controller_.start(config_.goal), "");
}

TEST_F(InjectionRunTest, HandsInjectionIsNamedAndNotMoved) {
  config_.mode = "manual";
  enable();
  std::vector<std::string> states;
  const auto go = [&](double z, int count) {
    const Eigen::Vector3d from = *rig_.input.target;
    for (int i = 1; i <= count; ++i) {
      rig_.input.target = from + (Eigen::Vector3d(0, 0, z) - from) * i / count;
      rig_.step(controller_);
      if (states.empty() || states.back() != toText(controller_.injection()))
        states.push_back(toText(controller_.injection()));
      EXPECT_LT((*rig_.setpoint - *rig_.input.target).norm(), 1e-12);
    }
  };
  rig_.input.target = rig_.tip;
  go(40e-6, 400);
  go(14e-6, 1000);
  go(14e-6, 100);
  EXPECT_EQ(controller_.command("inject"), "");
  EXPECT_TRUE(controller_.pulse());
  go(14e-6, 400);
  EXPECT_NEAR(rig_.volume, 0.2e-15, 2e-18);
  go(40e-6, 1000);
  EXPECT_EQ(states, (std::vector<std::string>{"idle", "approach", "contact", "indent", "punctured", "inject",
                                              "punctured", "withdraw", "idle", "approach"}));
}

TEST_F(InjectionRunTest, HandIsStoppedAtTheDepthLimit) {
  config_.mode = "manual";
  config_.guards.depth_limit = 5e-6;
  rig_.input.target = rig_.tip;
  enable();
  for (int i = 0; i < 3000; ++i) {
    if (i > 400) *rig_.input.target -= Eigen::Vector3d(0, 0, 10e-9);
    rig_.step(controller_);
  }
  EXPECT_NEAR(rig_.depth(), 5e-6, 1.0e-6);
  EXPECT_NE(controller_.heldBecause().find("only be withdrawn"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
