// What must not move the needle, and what must not be forgotten.

#include <string>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

class InjectionSafetyTest : public InjectionFixture {
 protected:
  /// By hand: rests, then goes down by `way` (m) at `speed` (m/s).
  void press(double way, double speed = 10e-6) {
    const int count = static_cast<int>(way / (speed * SpringRig::kStep));
    for (int i = 0; i < count; ++i) {
      *rig_.input.target -= Eigen::Vector3d(0, 0, speed * SpringRig::kStep);
      rig_.step(controller_);
    }
  }
  void takeInHand() {
    config_.mode = "manual";
    rig_.input.target = rig_.tip;
    enable();
    steps(400);
  }
  void again() {
    controller_.command("disable");
    steps(10);
    controller_.command("enable");
    steps(500);
  }
};

/// The rig was stopped, or stands still for another reason: let go on, it must not leap to a set-point that ran away.
TEST_F(InjectionSafetyTest, TheSetPointWaitsForANeedleThatStandsStill) {
  for (const bool by_hand : {false, true}) {
    rig_ = SpringRig();
    rig_.puncture_force = 1;
    config_.mode = "automatic";
    if (by_hand) takeInHand();
    if (!by_hand) enable();
    controller_.adaptTo(1, rig_.lag);
    while (rig_.depth() < 5e-6) by_hand ? press(10e-9) : rig_.step(controller_);
    const double lag = rig_.lag, before = rig_.depth();
    rig_.lag = 1e9;
    by_hand ? press(40e-6) : steps(4000);
    EXPECT_LT(rig_.tip.z() - rig_.setpoint->z(), 2 * 200e-6 * lag + 1.1e-6);
    EXPECT_EQ(controller_.holdReason(), "the needle does not follow its set-point");
    rig_.lag = lag;
    steps(10);
    EXPECT_LT(rig_.depth(), before + 2 * 200e-6 * lag + 1.1e-6 + 10 * 0.2e-6) << by_hand;
    if (!by_hand) continue;
    const double then = rig_.depth();
    steps(1000);
    EXPECT_LT(rig_.depth(), then + 2e-6) << "what the hand did meanwhile is forgotten";
  }
}

/// Whoever holds the rig: the set-point is the needle's place meanwhile, and a person lets the injection go on.
TEST_F(InjectionSafetyTest, ARigThatDoesNotFollowPausesTheInjection) {
  for (const InjectionState state :
       {InjectionState::kApproach, InjectionState::kIndent, InjectionState::kInject, InjectionState::kWithdraw}) {
    SCOPED_TRACE(toText(state));
    rig_ = SpringRig();
    enable();
    controller_.adaptTo(1, 0.3);
    ASSERT_TRUE(reach(state));
    steps(20);
    rig_.input.rig_hold = "DISABLED";
    const Eigen::Vector3d held = rig_.tip;
    for (int i = 0; i < 3000; ++i) {
      rig_.step(controller_);
      EXPECT_EQ(*rig_.setpoint, held);
      EXPECT_FALSE(controller_.pulse());
    }
    EXPECT_EQ(controller_.state(), OperatingState::kPaused);
    EXPECT_NE(controller_.holdReason().find("DISABLED"), std::string::npos) << controller_.holdReason();
    rig_.input.rig_hold.clear();
    steps(500);
    EXPECT_EQ(rig_.tip, held) << "nothing moves before resume";
    if (state == InjectionState::kInject) continue;  // the pulse is lost: the injection has ended
    EXPECT_EQ(controller_.command("resume"), "");
    rig_.step(controller_);
    EXPECT_LT((rig_.tip - held).norm(), 0.3e-6) << "nothing leaps";
    rig_.run(controller_);
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
  }
}

TEST_F(InjectionSafetyTest, ANeedleThatIsMovedWhileTheRigIsDisabledEndsTheInjection) {
  enable();
  controller_.adaptTo(1, rig_.lag);
  ASSERT_TRUE(reach(InjectionState::kIndent));
  rig_.input.rig_hold = "DISABLED";
  steps(10);
  rig_.tip.z() += 10e-6;
  steps(10);
  EXPECT_FALSE(controller_.running());
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("moved meanwhile"), std::string::npos) << controller_.result().reason;
}

TEST_F(InjectionSafetyTest, NothingBeginsBeforeTheRigFollows) {
  rig_.input.rig_hold = "DISABLED";
  enable();
  steps(2000);
  EXPECT_FALSE(controller_.running());
  EXPECT_FALSE(rig_.setpoint);
  rig_.input.rig_hold.clear();
  steps(2);
  EXPECT_TRUE(controller_.running());
}

TEST_F(InjectionSafetyTest, WhatTheHandDoesWhileTheRigIsDisabledIsForgotten) {
  takeInHand();
  press(5e-6);
  rig_.input.rig_hold = "DISABLED";
  const Eigen::Vector3d held = rig_.tip;
  press(8e-6);
  EXPECT_EQ(controller_.holdReason(), "DISABLED");
  EXPECT_EQ(controller_.state(), OperatingState::kEnabled) << "the hand leads on";
  rig_.input.rig_hold.clear();
  steps(500);
  EXPECT_LT((rig_.tip - held).norm(), 0.01e-6);
  press(2e-6);
  steps(100);
  EXPECT_NEAR((held - rig_.tip).z(), 2e-6, 0.1e-6);
}

TEST_F(InjectionSafetyTest, AGuardStopsALateNeedleAndNotItsSetPoint) {
  for (const double lag : {0.002, 0.1, 0.35}) {
    for (const bool by_hand : {false, true}) {
      rig_ = SpringRig();
      rig_.lag = lag;
      rig_.puncture_force = 1;
      config_.guards.force_limit = 0.8e-6;
      config_.mode = "automatic";
      if (by_hand) takeInHand();
      if (!by_hand) enable();
      controller_.adaptTo(1, lag);
      by_hand ? press(40e-6, 100e-6) : rig_.run(controller_);
      steps(3000);
      // What one cycle's motion and the noise of the force may add; a needle goes some um on in its lag.
      EXPECT_LT(rig_.largest_force, 0.8e-6 + 0.06e-6) << lag << by_hand;
      EXPECT_GT(rig_.largest_force, 0.7e-6) << lag << by_hand;
    }
  }
}

TEST_F(InjectionSafetyTest, DisabledAndEnabledInTheCellStartsNothingAndKnowsTheWayOut) {
  rig_.puncture_force = 1;
  for (const char* way_out : {"withdraw", "home"}) {
    for (const bool fault : {false, true}) {
      rig_ = SpringRig();
      rig_.puncture_force = 1;
      const Eigen::Vector3d start = rig_.tip;
      enable();
      ASSERT_TRUE(reach(InjectionState::kIndent));
      while (rig_.depth() < 20e-6) rig_.step(controller_);
      if (fault) {
        rig_.sense(controller_);
        *rig_.input.needle += Eigen::Vector3d(60e-6, 0, 0);
        rig_.setpoint = controller_.step(rig_.input, SpringRig::kStep);
        ASSERT_EQ(controller_.state(), OperatingState::kFault);
      }
      for (int i = 0; i < 2; ++i) again();
      const double deep = rig_.depth();
      EXPECT_NEAR(controller_.monitor().depth(), deep, 1e-6);
      EXPECT_NEAR(controller_.monitor().force(), rig_.force(), 0.05e-6) << "the offset is that out of the cell";
      EXPECT_NE(controller_.command("approach").find("in the cell"), std::string::npos);
      EXPECT_EQ(controller_.command(way_out), "");
      for (int i = 0; i < 20000 && controller_.busy(); ++i) rig_.step(controller_);
      steps(100);
      EXPECT_LT((rig_.tip - start).norm(), 1e-8) << way_out << fault;
      EXPECT_LT(rig_.deepest, deep + 1e-6);
      controller_.command("resume");
      EXPECT_EQ(controller_.command("approach"), "") << "out again";
    }
  }
}

TEST_F(InjectionSafetyTest, TakenOutBySomebodyElseItIsOut) {
  rig_.puncture_force = 1;
  config_.start_when_enabled = false;
  enable();
  controller_.command("approach");
  ASSERT_TRUE(reach(InjectionState::kIndent));
  steps(500);
  controller_.command("disable");
  steps(1);
  rig_.tip.z() = 35e-6;
  steps(10);
  rig_.tip.z() = 29e-6;
  controller_.command("enable");
  steps(500);
  EXPECT_EQ(controller_.command("approach"), "");
}

TEST_F(InjectionSafetyTest, TheHandsDepthOutlastsDisable) {
  rig_.puncture_force = 1;
  config_.guards.depth_limit = 30e-6;
  takeInHand();
  press(12e-6 + 20e-6);
  again();
  press(30e-6);
  EXPECT_NEAR(rig_.depth(), 30e-6, 1.5e-6);
  EXPECT_NE(controller_.holdReason().find("depth past the touch"), std::string::npos);
  EXPECT_EQ(controller_.command("home"), "");
  for (int i = 0; i < 20000 && controller_.busy(); ++i) rig_.step(controller_);
  EXPECT_EQ(rig_.depth(), 0);
}

TEST_F(InjectionSafetyTest, WithdrawGoesOnAfterATimeGuardOnTheWayOut) {
  config_.guards.time_limit = 1.9;
  config_.motion.indent_speed = 20e-6;
  config_.motion.retract_speed = 10e-6;
  config_.goal.margin = 10e-6;
  enable();
  rig_.run(controller_);
  EXPECT_NE(controller_.result().reason.find("time in state withdraw"), std::string::npos);
  ASSERT_EQ(controller_.injection(), InjectionState::kWithdraw);
  for (int i = 0; i < 3 && controller_.injection() != InjectionState::kIdle; ++i) {
    EXPECT_EQ(controller_.command("withdraw"), "");
    rig_.run(controller_);
  }
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  EXPECT_EQ(rig_.depth(), 0);
}

TEST_F(InjectionSafetyTest, APausedPulseEndsAtItsVolume) {
  config_.goal.pulse.volume = 0.05e-15;
  enable();
  ASSERT_TRUE(reach(InjectionState::kInject));
  steps(10);
  controller_.command("pause");
  steps(1000);
  EXPECT_FALSE(controller_.pulse());
  EXPECT_NEAR(rig_.volume, 0.05e-15, 3e-18);
  controller_.command("resume");
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
}

TEST_F(InjectionSafetyTest, APulseThatWasBrokenOffIsNoInjection) {
  for (const bool by_volume : {false, true}) {
    rig_ = SpringRig();
    config_.goal.pulse.volume = by_volume ? 1e-12 : 0;
    enable();
    ASSERT_TRUE(reach(InjectionState::kInject));
    for (int i = 0; i < 100; ++i) {
      rig_.sense(controller_);
      rig_.input.injector = InjectorReport{i < 20, 0, by_volume};
      rig_.setpoint = controller_.step(rig_.input, SpringRig::kStep);
      rig_.move();
    }
    rig_.run(controller_);
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotInjected) << by_volume;
    EXPECT_EQ(rig_.depth(), 0);
  }
}

TEST_F(InjectionSafetyTest, APulseThatTheInjectorRefusesEndsTheInjectionAtOnceWithItsReason) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kInject));
  rig_.sense(controller_);
  rig_.input.injector = InjectorReport{false, 0, false, "pulse duration = 0.3 s, allowed [0.4, 60] s"};
  rig_.setpoint = controller_.step(rig_.input, SpringRig::kStep);
  EXPECT_FALSE(controller_.pulse());
  EXPECT_EQ(controller_.injection(), InjectionState::kWithdraw);
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kNotInjected);
  EXPECT_EQ(controller_.result().reason, "the injector refused the pulse: pulse duration = 0.3 s, allowed [0.4, 60] s");
  EXPECT_EQ(rig_.depth(), 0);
}

TEST_F(InjectionSafetyTest, WhatAPersonHasPausedIsPausedAgainWhenItIsOut) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kIndent));
  controller_.command("pause");
  steps(50);
  EXPECT_EQ(controller_.command("withdraw"), "");
  rig_.run(controller_);
  EXPECT_EQ(rig_.depth(), 0);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_NE(controller_.start(config_.goal), "");
  controller_.command("resume");
  EXPECT_EQ(controller_.start(config_.goal), "");
}

TEST_F(InjectionSafetyTest, ANeedleThatIsLostForLongEndsTheInjection) {
  config_.guards.time_limit = 5;
  enable();
  ASSERT_TRUE(reach(InjectionState::kApproach));
  steps(400);
  rig_.needle_tells = false;
  steps(6000);
  EXPECT_FALSE(controller_.running());
  EXPECT_NE(controller_.result().reason.find("time in state approach"), std::string::npos);
  rig_.needle_tells = true;
  expectSafe("known again");
}

/// However slowly the hand creeps into however soft a cell, the touch is felt and the depth guard sees it.
TEST_F(InjectionSafetyTest, ACreepingHandIsFelt) {
  struct Case {
    double stiffness, speed, noise;
  };
  for (const Case& hard : {Case{0.1, 0.2e-6, 0}, {0.1, 1e-6, 10e-9}, {0.01, 2e-6, 0}, {0.01, 5e-6, 10e-9}}) {
    rig_ = SpringRig();
    rig_.tip.z() = 28.5e-6;
    rig_.stiffness = hard.stiffness;
    rig_.noise = hard.noise;
    rig_.puncture_force = 1;
    config_.guards.depth_limit = 10e-6;
    takeInHand();
    press(20e-6, hard.speed);
    EXPECT_EQ(controller_.injection(), InjectionState::kIndent) << hard.stiffness << ' ' << hard.speed;
    EXPECT_LT(rig_.depth(), 10e-6 + 0.06e-6 / hard.stiffness) << hard.stiffness << ' ' << hard.speed;
  }
}

TEST_F(InjectionSafetyTest, InjectNeedsATrustedNeedle) {
  takeInHand();
  press(26e-6);
  ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
  rig_.needle_tells = false;
  steps(5);
  EXPECT_NE(controller_.command("inject").find("held: no valid needle"), std::string::npos);
  rig_.needle_tells = true;
  steps(5);
  EXPECT_EQ(controller_.command("inject"), "");
}

}  // namespace
}  // namespace microinjection
