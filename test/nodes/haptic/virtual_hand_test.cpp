// The virtual hand alone: the test is the bridge.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "cell_microinjection/LoopState.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

constexpr char kMotion[] =
    "path:\n"
    "  - {phase: approach, duration: 0.05, z: 0.0, clutch: true}\n"
    "  - {phase: indent, duration: 0.5, z: -0.01}\n";

class OperatorTest : public testing::Test {
 protected:
  OperatorTest() {
    std::ofstream(session_.folder() / "motion.yaml") << kMotion;
    hand();
    clutch();
    phase();
    session_.add("virtual_hand", "{start_delay: 0, diagnostic_period: 0.1, motion: " +
                                     (session_.folder() / "motion.yaml").string() + "}");
  }

  void tell(const std::string& hold_reason) {
    cell_microinjection::LoopState state;
    state.follows = hold_reason.empty();
    state.hold_reason = hold_reason;
    session_.world().sayNow("haptic/loop_state", state, true);
  }
  double hand() {
    const auto* message = session_.world().hear<geometry_msgs::PoseStamped>("haptic/measured_cp").newest();
    return message ? message->pose.position.z : NAN;
  }
  int clutch() {
    const auto* message = session_.world().hear<sensor_msgs::Joy>("haptic/clutch").newest();
    return message ? message->buttons.at(0) : -1;
  }
  std::string phase() {
    const auto* message = session_.world().hear<cell_microinjection::StringStamped>("virtual_hand/phase").newest();
    return message ? message->string : "";
  }

  VirtualSession session_{{"hand.device:=virtual_hand"}};
};

/// Else its motion runs ahead of a bridge that starts late, and the needle ends short of the cell.
TEST_F(OperatorTest, RestsUntilTheNeedleFollows) {
  session_.run(1);
  EXPECT_EQ(hand(), 0);
  EXPECT_EQ(clutch(), 0) << "a bridge whose clutch is pressed does not follow";
  tell("no valid needle position");
  session_.run(1);
  EXPECT_EQ(hand(), 0);
  EXPECT_EQ(session_.diagnostics().text("virtual_hand: motion"),
            "waits until the needle follows: no valid needle position");
  tell("");
  session_.run(0.01);
  EXPECT_EQ(clutch(), 1);
  session_.run(2);
  EXPECT_NEAR(hand(), -0.01, 1e-4);
  EXPECT_EQ(phase(), "done");
}

/// The hand of a person goes on too, when the needle stops following for a moment.
TEST_F(OperatorTest, GoesOnWhenTheNeedleIsHeldLater) {
  tell("");
  session_.run(0.01);
  tell("clutch is pressed");
  session_.run(2);
  EXPECT_NEAR(hand(), -0.01, 1e-4);
}

}  // namespace
}  // namespace microinjection
