#include <limits>
#include <set>
#include <string>

#include "operation/control/injection_fixture.h"

namespace microinjection {
namespace {

using InjectionInterruptionTest = InjectionFixture;

TEST_F(InjectionInterruptionTest, InjectorThatIsDeadOrBrokenIsNotWaitedForLong) {
  rig_.injector_works = false;
  enable();
  ASSERT_TRUE(reach(InjectionState::kInject));
  rig_.run(controller_, 1400);
  EXPECT_NE(controller_.injection(), InjectionState::kInject);
  rig_.run(controller_);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjectorTimeOut);
  EXPECT_EQ(rig_.depth(), 0);
}

TEST_F(InjectionInterruptionTest, InjectorThatIsSilentLeavesTheNeedleWhereItIs) {
  enable();
  ASSERT_TRUE(reach(InjectionState::kInject));
  rig_.injector_tells = false;
  rig_.run(controller_, 1400);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjectorTimeOut);
  expectSafe("silent injector");
  EXPECT_GT(rig_.depth(), 0);
  EXPECT_EQ(controller_.command("withdraw"), "");
}

TEST_F(InjectionInterruptionTest, NoPulseGoesOnWhereNeedleOrForceIsNotKnown) {
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

TEST_F(InjectionInterruptionTest, PreemptedAtAnyMomentEndsOut) {
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

TEST_F(InjectionInterruptionTest, PausedAtAnyMomentHoldsAndGoesOn) {
  const InjectionMotionConfig& motion = config_.motion;
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
    const Eigen::Vector3d from = *rig_.setpoint;
    controller_.command("resume");
    rig_.step(controller_);
    const double advance = from.z() - rig_.setpoint->z();
    if (controller_.injection() == InjectionState::kIndent) {
      EXPECT_LE(advance, 1.001 * (motion.indent_speed + motion.stab_acceleration * SpringRig::kStep) * SpringRig::kStep)
          << where << ": a stab sets out slowly";
    }
    rig_.run(controller_);
    EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected) << where << controller_.result().reason;
  }
}

TEST_F(InjectionInterruptionTest, UntrustedInputsHoldInEachState) {
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
      const bool ends = state == State::kIndent || state == State::kInject;
      if (needle || state != State::kWithdraw) {
        // Where it ends the set-point comes back to the needle, which is behind by its lag.
        EXPECT_LT((*setpoint - held).norm(), ends && !needle ? 0.5e-6 : 1e-12) << where;
        EXPECT_GE(setpoint->z(), held.z()) << where;
      } else {
        EXPECT_GT(setpoint->z(), held.z() + 1e-6) << "no force is needed to withdraw";
      }
      rig_.run(controller_);
      const auto outcome = controller_.result().outcome;
      EXPECT_EQ(outcome, ends ? InjectionOutcome::kGuard : InjectionOutcome::kInjected) << where;
      expectSafe(where);
    }
  }
}

TEST_F(InjectionInterruptionTest, DisabledAtAnyMomentSaysNothing) {
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

}  // namespace
}  // namespace microinjection
