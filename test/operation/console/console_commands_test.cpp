#include "operation/console/console_commands.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "operation/console/guard_margins.h"
#include "operation/console/headline.h"
#include "operation/control/spring_rig.h"

namespace microinjection {
namespace {

/// What the console receives from a controller.
SessionView viewOf(const InjectionController& controller, const InjectionControllerConfig& config) {
  SessionView view;
  view.operating = controller.state();
  view.injection = controller.injection();
  view.homed = controller.homed();
  view.busy = controller.busy();
  view.waits = controller.awaitsCommand();
  view.force = controller.feedback().force;
  view.depth = controller.feedback().depth;
  view.volume = controller.injectedVolume();
  view.hold_reason = controller.holdReason();
  view.notice = controller.notice();
  view.settings = {config.mode,
                   config.goal.pulse.duration > 0,
                   config.holder,
                   config.goal.holding.suction > 0,
                   config.goal.break_by != BreakBy::kForce,
                   config.guards.force_limit,
                   config.guards.depth_limit,
                   ""};
  return view;
}

/// The console beside the real controller, in front of a cell of springs.
class ConsoleBesideController : public testing::Test {
 protected:
  void begin(const std::string& mode, double holding_suction = 0) {
    config_ = {};
    config_.holder = holding_suction > 0;
    config_.goal.holding.suction = holding_suction;
    config_.goal.holding.release = config_.holder;
    config_.mode = mode;
    config_.goal.depth = 30e-6;
    config_.goal.pulse.duration = 0.3;
    config_.motion.stop_time = 5e-3;
    controller_ = InjectionController(config_);
    rig_ = {};
    rig_.input.target = rig_.tip;
    // The node's first inputs come before anyone presses a button.
    press(ConsoleCommand::kEnable);
    steps(5);
  }

  CommandOffer offered(ConsoleCommand command) { return offer(command, viewOf(controller_, config_)); }

  std::string press(ConsoleCommand command) { return controller_.command(offered(command).command); }

  /// Each button is greyed if and only if the controller refuses its command now, for the same reason.
  void compare() {
    for (const ConsoleCommand command : kConsoleCommands) {
      const CommandOffer shown = offered(command);
      InjectionController copy = controller_;
      const std::string refusal = copy.command(shown.command);
      const bool idle_command = shown.refusal == "it is enabled" || shown.refusal == "it is disabled";
      if (idle_command) {
        EXPECT_EQ(copy.state(), controller_.state());
        continue;
      }
      EXPECT_EQ(shown.refusal, refusal) << shown.command << " while " << toText(controller_.state()) << ", "
                                        << toText(controller_.injection()) << ", " << config_.mode;
      ++compared_;
      if (!refusal.empty()) ++refused_;
    }
    states_.insert(controller_.injection());
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      rig_.step(controller_);
      if (i % 20 == 0) compare();
    }
  }

  /// Steps until the controller waits in that state.
  bool waitsIn(InjectionState state) {
    for (int i = 0; i < 500; ++i) {
      if (controller_.injection() == state && controller_.awaitsCommand()) return true;
      steps(20);
    }
    return false;
  }

  bool reaches(InjectionState state) {
    for (int i = 0; i < 20000 && controller_.injection() != state; ++i) steps(1);
    return controller_.injection() == state;
  }

  InjectionControllerConfig config_;
  InjectionController controller_{config_};
  SpringRig rig_;
  int compared_ = 0, refused_ = 0;
  std::set<InjectionState> states_;
};

TEST_F(ConsoleBesideController, AgreesInAWholeInjectionByButtons) {
  begin("semi_automatic");
  EXPECT_EQ(press(ConsoleCommand::kApproach), "");
  ASSERT_TRUE(waitsIn(InjectionState::kContact));
  EXPECT_EQ(press(ConsoleCommand::kIndent), "");
  ASSERT_TRUE(waitsIn(InjectionState::kPunctured));
  EXPECT_EQ(press(ConsoleCommand::kInject), "");
  ASSERT_TRUE(reaches(InjectionState::kInject));
  ASSERT_TRUE(waitsIn(InjectionState::kPunctured));
  EXPECT_EQ(offered(ConsoleCommand::kInject).refusal, "it is injected already");
  EXPECT_EQ(press(ConsoleCommand::kWithdraw), "");
  ASSERT_TRUE(reaches(InjectionState::kIdle));
  steps(100);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kInjected);
  EXPECT_EQ(states_.size(), 7U);
  EXPECT_GT(refused_, 100);
  EXPECT_GT(compared_ - refused_, 100);
}

TEST_F(ConsoleBesideController, AgreesWhereAHolderTakesTheCell) {
  begin("semi_automatic", 1500);
  EXPECT_EQ(press(ConsoleCommand::kHold), "");
  ASSERT_TRUE(waitsIn(InjectionState::kHold));
  EXPECT_EQ(press(ConsoleCommand::kApproach), "");
  ASSERT_TRUE(waitsIn(InjectionState::kContact));
  EXPECT_EQ(press(ConsoleCommand::kIndent), "");
  ASSERT_TRUE(waitsIn(InjectionState::kPunctured));
  EXPECT_EQ(press(ConsoleCommand::kInject), "");
  ASSERT_TRUE(reaches(InjectionState::kInject));
  ASSERT_TRUE(waitsIn(InjectionState::kPunctured));
  EXPECT_EQ(press(ConsoleCommand::kWithdraw), "");
  ASSERT_TRUE(waitsIn(InjectionState::kRelease));
  EXPECT_EQ(press(ConsoleCommand::kRelease), "");
  ASSERT_TRUE(reaches(InjectionState::kIdle));
  steps(100);
  EXPECT_EQ(press(ConsoleCommand::kRelease), "") << "also without an injection";
  begin("automatic", 1500);
  ASSERT_TRUE(reaches(InjectionState::kRelease));
  ASSERT_TRUE(reaches(InjectionState::kIdle));
  begin("manual", 1500);
  EXPECT_EQ(press(ConsoleCommand::kHold), "");
  steps(600);
  EXPECT_EQ(press(ConsoleCommand::kRelease), "");
}

TEST_F(ConsoleBesideController, AgreesInAnAutomaticInjection) {
  begin("automatic");
  ASSERT_TRUE(reaches(InjectionState::kInject));
  ASSERT_TRUE(reaches(InjectionState::kIdle));
  EXPECT_EQ(states_.size(), 7U);
}

TEST_F(ConsoleBesideController, AgreesByHand) {
  begin("manual");
  for (int i = 0; i < 20000 && controller_.injection() != InjectionState::kPunctured; ++i) {
    rig_.input.target = *rig_.input.target - Eigen::Vector3d(0, 0, 20e-9);
    steps(1);
  }
  ASSERT_EQ(controller_.injection(), InjectionState::kPunctured);
  EXPECT_EQ(press(ConsoleCommand::kInject), "");
  steps(20);
  EXPECT_EQ(controller_.injection(), InjectionState::kInject);
  steps(2000);
  EXPECT_EQ(press(ConsoleCommand::kHome), "");
  steps(5000);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
}

TEST_F(ConsoleBesideController, AgreesAfterPauseHomeGuardFaultAndDisableInTheCell) {
  begin("semi_automatic");
  press(ConsoleCommand::kApproach);
  steps(100);
  press(ConsoleCommand::kStop);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  steps(100);
  EXPECT_EQ(offered(ConsoleCommand::kEnable).label, "Resume");
  EXPECT_EQ(press(ConsoleCommand::kEnable), "");
  ASSERT_TRUE(waitsIn(InjectionState::kContact));
  press(ConsoleCommand::kIndent);
  ASSERT_TRUE(reaches(InjectionState::kIndent));
  steps(50);
  press(ConsoleCommand::kDisable);
  steps(100);
  EXPECT_EQ(press(ConsoleCommand::kEnable), "");
  steps(100);
  EXPECT_NE(offered(ConsoleCommand::kApproach).refusal, "");
  EXPECT_EQ(press(ConsoleCommand::kWithdraw), "");
  steps(60);
  ASSERT_TRUE(reaches(InjectionState::kIdle));
  steps(5000);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_EQ(press(ConsoleCommand::kEnable), "");
  controller_.command("unhome");
  steps(50);
  EXPECT_EQ(press(ConsoleCommand::kHome), "");
  steps(3000);
  rig_.tip.x() += 200e-6;
  press(ConsoleCommand::kEnable);
  steps(50);
  EXPECT_EQ(controller_.state(), OperatingState::kFault);
  EXPECT_EQ(headline(viewOf(controller_, config_)).light, Light::kRed);
  press(ConsoleCommand::kDisable);
  steps(50);
}

TEST_F(ConsoleBesideController, StopHoldsTheNeedleInEveryState) {
  for (const InjectionState state : {InjectionState::kApproach, InjectionState::kContact, InjectionState::kIndent,
                                     InjectionState::kPunctured, InjectionState::kInject, InjectionState::kWithdraw}) {
    begin("automatic");
    ASSERT_TRUE(reaches(state)) << toText(state);
    EXPECT_EQ(press(ConsoleCommand::kStop), "") << toText(state);
    EXPECT_FALSE(controller_.pulse()) << "a pulse goes on after stop in " << toText(state);
    steps(100);
    const Eigen::Vector3d before = rig_.tip;
    steps(100);
    EXPECT_LT((rig_.tip - before).norm(), 1e-9) << toText(state);
  }
}

TEST_F(ConsoleBesideController, StopTwiceDisables) {
  begin("automatic");
  ASSERT_TRUE(reaches(InjectionState::kApproach));
  press(ConsoleCommand::kStop);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  press(ConsoleCommand::kStop);
  EXPECT_EQ(controller_.state(), OperatingState::kDisabled);
}

/// What is sent before the controller has connected is lost.
TEST(ConsoleCommands, BeforeTheControllerListensOnlyStopIsOffered) {
  SessionView session;
  session.operating = OperatingState::kDisabled;
  session.injection = InjectionState::kIdle;
  EXPECT_EQ(offer(ConsoleCommand::kEnable, session).refusal, "");
  session.listens = false;
  for (const ConsoleCommand command : kConsoleCommands) {
    const bool stop = command == ConsoleCommand::kStop;
    EXPECT_EQ(offer(command, session).refusal, stop ? "" : "injection_controller does not receive commands yet");
  }
}

TEST(ConsoleCommands, WithoutAControllerOnlyStopIsOffered) {
  const SessionView silent;
  for (const ConsoleCommand command : kConsoleCommands) {
    EXPECT_EQ(offer(command, silent).refusal.empty(), command == ConsoleCommand::kStop);
  }
  EXPECT_EQ(offer(ConsoleCommand::kStop, silent).command, "disable");
  EXPECT_EQ(headline(silent).light, Light::kRed);
}

}  // namespace
}  // namespace microinjection
