// Rules that a whole injection that goes well does not show.

#include <string>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

class InjectionRulesTest : public InjectionFixture {
 protected:
  void stepWith(const Eigen::Vector3d& more_force, const Eigen::Vector3d& more_needle = Eigen::Vector3d::Zero()) {
    rig_.sense(controller_);
    *rig_.input.force += more_force;
    *rig_.input.needle += more_needle;
    rig_.setpoint = controller_.step(rig_.input, SpringRig::kStep);
    rig_.move();
  }
  void takeInHand() {
    config_.mode = "manual";
    rig_.input.target = rig_.tip;
    enable();
    steps(400);
  }
  void go(double z, double speed = 10e-6) {
    const double step = speed * SpringRig::kStep;
    while (std::abs(rig_.input.target->z() - z) > step) {
      rig_.input.target->z() += rig_.input.target->z() < z ? step : -step;
      rig_.step(controller_);
    }
  }
  /// Fastest (m/s) set-point of the state indent, first membrane.
  double fastestStab() {
    rig_ = SpringRig();
    enable();
    double fastest = 0;
    while (controller_.busy() && controller_.result().punctures == 0) {
      const Eigen::Vector3d before = *rig_.setpoint;
      rig_.step(controller_);
      if (controller_.injection() == InjectionState::kIndent)
        fastest = std::max(fastest, (*rig_.setpoint - before).norm() / SpringRig::kStep);
    }
    return fastest;
  }
};

TEST_F(InjectionRulesTest, ARefusedWithdrawalSaysWhatIsMissing) {
  controller_ = InjectionController(config_);
  EXPECT_EQ(controller_.command("withdraw"), "state is DISABLED, withdraw is allowed in ENABLED and PAUSED");
  controller_.command("enable");
  EXPECT_EQ(controller_.command("withdraw"), "the needle's position is not known yet");
}

TEST_F(InjectionRulesTest, DepthAndForceAcrossEndItWhereverTheyComeFrom) {
  rig_.puncture_force = 1;
  config_.guards.depth_limit = config_.goal.depth = 15e-6;
  enable();
  ASSERT_TRUE(reach(InjectionState::kIndent));
  while (rig_.depth() < 10e-6) rig_.step(controller_);
  stepWith(Eigen::Vector3d::Zero(), {0, 0, -8e-6});  // the rig goes deeper than it was told
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("depth past the touch"), std::string::npos);

  rig_ = SpringRig();
  config_.guards.depth_limit = 50e-6;
  config_.guards.lateral_force_limit = 1e-6;
  enable();
  ASSERT_TRUE(reach(InjectionState::kIndent));
  stepWith({0, 1.1e-6, 0});
  EXPECT_NE(controller_.result().reason.find("force across the pipette"), std::string::npos);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
}

TEST_F(InjectionRulesTest, ATouchThatWasNoneIsLookedAtTwice) {
  enable();
  steps(400);
  ASSERT_EQ(controller_.injection(), InjectionState::kApproach);
  for (int i = 0; i < 20 && controller_.injection() == InjectionState::kApproach; ++i) stepWith({0, 0, 0.2e-6});
  ASSERT_EQ(controller_.injection(), InjectionState::kContact);
  steps(100);
  EXPECT_EQ(controller_.injection(), InjectionState::kApproach);
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().false_touches, 1);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
}

TEST_F(InjectionRulesTest, WhatTheForceDidWhileItWasNotKnownIsNoPuncture) {
  rig_.puncture_force = 10;
  takeInHand();
  go(18e-6);
  ASSERT_EQ(controller_.injection(), InjectionState::kIndent);
  rig_.force_tells = false;
  steps(50);
  rig_.force_tells = true;
  rig_.stiffness *= 0.4;
  go(16e-6, 100e-6);
  EXPECT_EQ(controller_.injection(), InjectionState::kIndent);
}

TEST_F(InjectionRulesTest, TheHandTurnsBackAndInAgain) {
  rig_.puncture_force = 1;
  takeInHand();
  go(18e-6);
  go(19.5e-6);
  EXPECT_EQ(controller_.injection(), InjectionState::kIndent) << "trembling";
  go(21e-6);
  EXPECT_EQ(controller_.injection(), InjectionState::kWithdraw);
  go(18e-6);
  EXPECT_EQ(controller_.injection(), InjectionState::kIndent);
}

TEST_F(InjectionRulesTest, TheStabIsAsFastAsItsOvershootAllows) {
  config_.motion.stab_speed = 2e-3;
  config_.guards.speed_limit = 2e-3;
  enable();
  ASSERT_TRUE(reach(InjectionState::kPunctured));
  steps(20);
  EXPECT_LT(rig_.deepest - rig_.punctured_at, config_.motion.overshoot);
  EXPECT_GT(rig_.deepest - rig_.punctured_at, 0.2 * config_.motion.overshoot) << "needlessly slow";
  const double one = fastestStab();
  config_.goal.layers = 2;
  EXPECT_LT(fastestStab(), 0.75 * one) << "half the overshoot before a second membrane";
  config_.guards.speed_limit = 50e-6;
  EXPECT_NEAR(fastestStab(), 50e-6, 1e-9);
}

TEST_F(InjectionRulesTest, ANeedleThatMovesWhilePausedIsAFault) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kIndent));
  controller_.command("pause");
  steps(10);
  stepWith(Eigen::Vector3d::Zero(), {1.1 * config_.guards.tracking_limit, 0, 0});
  EXPECT_EQ(controller_.state(), OperatingState::kFault);
}

TEST_F(InjectionRulesTest, AHandsPulseEndsWithTheInjectorsPatienceOrTheNeedlesWayOut) {
  for (const bool withdrawn : {false, true}) {
    rig_ = SpringRig();
    rig_.injector_works = false;
    takeInHand();
    go(14e-6);
    ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
    ASSERT_EQ(controller_.command("inject"), "");
    steps(50);
    ASSERT_TRUE(controller_.pulse());
    if (withdrawn) go(17e-6, 100e-6);
    if (!withdrawn) steps(static_cast<int>(1e3 * (config_.goal.pulse.duration + config_.motion.injector_timeout)));
    EXPECT_FALSE(controller_.pulse()) << withdrawn;
    EXPECT_EQ(controller_.injection(), withdrawn ? InjectionState::kWithdraw : InjectionState::kPunctured);
  }
}

TEST_F(InjectionRulesTest, APulseThatAFootHasSetOffIsNamed) {
  takeInHand();
  go(14e-6);
  ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
  rig_.sense(controller_);
  rig_.input.injector->busy = true;
  controller_.step(rig_.input, SpringRig::kStep);
  EXPECT_EQ(controller_.injection(), InjectionState::kInject);
  steps(1);
  EXPECT_EQ(controller_.injection(), InjectionState::kPunctured);
}

TEST_F(InjectionRulesTest, WaitingForTheOperatorIsNotTimed) {
  config_.mode = "semi_automatic";
  config_.guards.time_limit = 2;
  enable();
  controller_.command("approach");
  ASSERT_TRUE(reach(InjectionState::kContact));
  steps(3000);
  EXPECT_TRUE(controller_.running());
  EXPECT_EQ(controller_.command("indent"), "");
}

TEST_F(InjectionRulesTest, ItHoldsForTheHoldTime) {
  double durations[2];
  for (const double hold : {0.0, 1.0}) {
    rig_ = SpringRig();
    config_.goal.hold_time = hold;
    enable();
    rig_.run(controller_);
    durations[hold > 0 ? 1 : 0] = controller_.result().duration;
  }
  EXPECT_NEAR(durations[1] - durations[0], 1, 0.01);
}

TEST_F(InjectionRulesTest, HomeEndsTheInjection) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kIndent));
  const Eigen::Vector3d home(0, 0, 40e-6);
  EXPECT_EQ(controller_.command("home"), "");
  EXPECT_FALSE(controller_.running());
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kPreempted);
  rig_.run(controller_);
  steps(50);
  EXPECT_LT((rig_.tip - home).norm(), 1e-8);
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
}

TEST_F(InjectionRulesTest, ThePeakIsThatOfTheWholeInjection) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kIndent));
  stepWith({0, 0, 3e-6});
  rig_.run(controller_);
  EXPECT_NEAR(controller_.result().peak_force, 3e-6, 0.3e-6);
}

}  // namespace
}  // namespace microinjection
