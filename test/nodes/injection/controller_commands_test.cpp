#include <gtest/gtest.h>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/OperatingState.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

using cell_microinjection::InjectionStatus;
using cell_microinjection::OperatingState;
using geometry_msgs::PoseStamped;

/// A command without a stamp whose publisher latches comes again to a controller that starts anew: it moves nothing
/// then. Said again it is obeyed, as those of CRTK clients are.
class ControllerCommandsTest : public testing::Test {
 protected:
  static constexpr char kStatus[] = "injection_controller: control";

  /// Without a stamp, by who latches.
  void say(const std::string& word) {
    cell_microinjection::StringStamped message;
    message.string = word;
    asker_.say("controller/state_command", message, true);
  }
  /// The controller starts, ENABLED, with a needle and a cell that it does not touch.
  void begin() {
    TestNode& world = session_.world();
    world.hear<PoseStamped>("needle/servo_cp");
    world.hear<InjectionStatus>("controller/injection_state");
    world.hear<OperatingState>("controller/operating_state");
    world.repeat<PoseStamped>("needle/measured_cp", [&world] {
      const auto* const setpoint = world.hear<PoseStamped>("needle/servo_cp").newest();
      return std::optional(poseMessage(0, 0, setpoint ? setpoint->pose.position.z : 60e-6));
    });
    world.repeat("cell/predicted_cf", wrenchMessage(0, 0, 0));
    session_.add("injection_controller", "{injector: false, diagnostic_period: 0.1}");
    session_.run(0.2);
  }
  const InjectionStatus& injection() {
    return *session_.world().hear<InjectionStatus>("controller/injection_state").newest();
  }
  std::string operatingState() {
    return session_.world().hear<OperatingState>("controller/operating_state").newest()->state;
  }
  void expectObeyedOnlyWhenSaidAgain(const std::string& word) {
    say(word);
    begin();
    EXPECT_TRUE(session_.diagnostics().ever(
        kStatus, "state command " + word + " refused: it has no stamp and its publisher latches"))
        << session_.diagnostics().text(kStatus);
    EXPECT_EQ(injection().state, "idle");
    EXPECT_EQ(operatingState(), "ENABLED");
    say("approach");
    session_.run(2e-3);
    EXPECT_EQ(injection().state, "approach");
    say(word);
    EXPECT_TRUE(session_.until([&] { return injection().outcome == "preempted"; }, 5)) << injection();
  }

  VirtualSession session_{{"hand.device:=none", "display.markers:=false", "injection.mode:=semi_automatic",
                           "injection.start_when_enabled:=false"}};
  TestNode& asker_ = session_.addTestNode("asker");
};

TEST_F(ControllerCommandsTest, AnOldWithdrawMovesNothing) { expectObeyedOnlyWhenSaidAgain("withdraw"); }
TEST_F(ControllerCommandsTest, AnOldHomeMovesNothing) { expectObeyedOnlyWhenSaidAgain("home"); }

TEST_F(ControllerCommandsTest, WhatStopsIsObeyedHoweverOldItMayBe) {
  say("pause");
  begin();
  EXPECT_EQ(operatingState(), "PAUSED");
}

/// The same for the controller of a session that is killed and started again.
TEST_F(ControllerCommandsTest, ARestartedControllerMovesNothingByItself) {
  begin();
  say("approach");
  session_.run(2e-3);
  ASSERT_EQ(injection().state, "approach");
  say("home");
  ASSERT_TRUE(session_.until([&] { return injection().outcome == "preempted"; }, 5)) << injection();
  session_.executive().restart("injection_controller");
  session_.run(0.2);
  EXPECT_TRUE(
      session_.diagnostics().ever(kStatus, "state command home refused: it has no stamp and its publisher latches"));
  EXPECT_EQ(injection().state, "idle");
  EXPECT_EQ(operatingState(), "ENABLED");
}

}  // namespace
}  // namespace microinjection
