#include <gtest/gtest.h>

#include "cell/model/indentation.h"
#include "cell/model/scene.h"
#include "cell_microinjection/CellState.h"
#include "cell_microinjection/LoopState.h"
#include "led_hand.h"

namespace microinjection {
namespace {

/// N, along the needle, by the solver that a live cell has, without any node.
double liveForce(const std::string& file, double depth) {
  const Scene scene = loadScene(file);
  const auto cell = std::make_shared<const P1Cell>(scene);
  const Eigen::Vector3d touch(scene.needle.offset.x(), scene.needle.offset.y(), scene.radius());
  Indentation indentation(cell, cell->patchAt(touch, Eigen::Vector3d::UnitZ()));
  const IndentationSolution solution = indentation.solve({0, 0, -depth});
  EXPECT_TRUE(solution.converged) << solution.reason;
  return solution.force.z();
}

/// Hand to needle to cell to hand.
class ChainTest : public testing::Test {
 protected:
  ChainTest() {
    newestOf<cell_microinjection::CellState>("cell/state");
    newestOf<geometry_msgs::WrenchStamped>("force_sensor/measured_cf");
    newestOf<cell_microinjection::LoopState>("haptic/loop_state");
    newestOf<cell_microinjection::LoopState>("controller/loop_state");
    session_.add("micromanipulator");
    session_.add("force_sensor");
    session_.add("cell_simulator");
    session_.add("injection_controller", "{diagnostic_period: 0.1, injector: false}");
    session_.add("haptic_bridge", "{diagnostic_period: 0.1}");
    session_.run(0.15);  // the loop closes and its ramp is over
  }

  void press() { hand_.press(4e-6); }
  template <typename Message>
  const Message* newestOf(const std::string& topic) {
    return session_.world().hear<Message>(topic).newest();
  }
  const cell_microinjection::CellState& cell() { return *newestOf<cell_microinjection::CellState>("cell/state"); }
  void expectWarning(const std::string& name, const std::string& text) {
    const auto* status = session_.diagnostics().of(name);
    ASSERT_TRUE(status) << name;
    EXPECT_NE(status->level, diagnostic_msgs::DiagnosticStatus::OK) << name;
    EXPECT_NE(status->message.find(text), std::string::npos) << name << ": " << status->message;
  }
  void expectHeld(const std::string& reason) {
    const Eigen::Vector3d held = hand_.needle();
    hand_.z -= 5e-3;  // it would go deeper
    session_.run(1.5);
    EXPECT_LT((hand_.needle() - held).norm(), 1e-9);
    EXPECT_EQ(hand_.force().norm(), 0);
    expectWarning("haptic_bridge: loop", reason);
    expectWarning("injection_controller: control", "needle held");
    const auto* bridge = newestOf<cell_microinjection::LoopState>("haptic/loop_state");
    EXPECT_FALSE(bridge->follows);
    EXPECT_NE(bridge->hold_reason.find(reason), std::string::npos) << bridge->hold_reason;
    EXPECT_FALSE(newestOf<cell_microinjection::LoopState>("controller/loop_state")->follows);
    // The hand is back, 5 mm deeper: the needle must not leap there, the force must not kick.
    hand_.silent = false;
    hand_.instead.reset();
    session_.run(0.006);
    EXPECT_LT((hand_.needle() - held).norm(), 1e-9);
    session_.run(0.2);
    EXPECT_GT(hand_.force().z(), 0.05);
  }

  const std::string scene_ = testFile("scenes/coarse_oocyte.yaml");
  VirtualSession session_{{"cell:=" + scene_, "model:=live", "hand.device:=external", "hand.require_operator:=false"}};
  LedHand hand_{session_};
};

TEST_F(ChainTest, NoForceBeforeTheTouch) {
  hand_.press(-1e-6);
  EXPECT_LT((hand_.needle() - Eigen::Vector3d(0, 0, 29e-6)).norm(), 1e-9);
  EXPECT_EQ(hand_.force().norm(), 0);
}

TEST_F(ChainTest, TouchIsFeltWithTheRightSignAndSizeAndReleased) {
  press();
  ASSERT_TRUE(cell().in_contact);
  EXPECT_TRUE(cell().converged) << cell().reason;
  EXPECT_NEAR(cell().contact_point.z - cell().indentation, hand_.needle().z(), 1e-9);
  const double expected = liveForce(scene_, cell().indentation);
  EXPECT_GT(expected, 0.3e-6);
  EXPECT_NEAR(hand_.force().z() / (LedHand::kForceGain * expected), 1, 0.01);
  EXPECT_LT(hand_.force().head<2>().norm(), 0.05 * hand_.force().z());
  EXPECT_NEAR(newestOf<geometry_msgs::WrenchStamped>("force_sensor/measured_cf")->wrench.force.z, expected,
              0.01 * expected + 8 * 10e-9);  // the sensor's noise: 10 nN rms
  hand_.press(-3e-6);
  EXPECT_EQ(hand_.force().norm(), 0);
  EXPECT_FALSE(cell().in_contact);
}

TEST_F(ChainTest, SilentHandHoldsTheNeedle) {
  press();
  EXPECT_GT(hand_.force().z(), 0.05);
  hand_.silent = true;
  session_.run(0.06);  // past the time-out of 50 ms
  expectHeld("no valid hand position");
}

TEST_F(ChainTest, HandThatIsNotFiniteHoldsTheNeedle) {
  press();
  hand_.instead = poseMessage(0, NAN, hand_.z, "haptic");
  session_.run(0.06);
  expectHeld("no valid hand position");
}

TEST_F(ChainTest, ClutchMovesTheHandAlone) {
  hand_.moveTo(-10e-3);
  const Eigen::Vector3d before = hand_.needle();
  hand_.clutch(true);
  hand_.moveTo(0);
  EXPECT_LT((hand_.needle() - before).norm(), 1e-9);
  hand_.clutch(false);
  session_.run(0.005);
  EXPECT_LT((hand_.needle() - before).norm(), 1e-9);
  hand_.moveTo(10e-3);
  EXPECT_LT((hand_.needle() - before - Eigen::Vector3d(0, 0, 10e-6)).norm(), 1e-9);
}

/// A set-point that the manipulator refuses, as one in the glass below, moves nothing; but its pose is not unread. Of a
/// rig that lags, the set-point may be tens of micrometres ahead.
TEST(RefusedSetPointTest, TheNeedleFollowsAHandThatComesBack) {
  constexpr double kBack = 40e-6, kAhead = 21e-6;  // m: of the hand, and how far a set-point may be ahead
  VirtualSession session({"cell:=" + testFile("scenes/coarse_oocyte.yaml"), "model:=live", "hand.device:=external",
                          "hand.require_operator:=false", "rig.name:=emulated_scientifica"});
  LedHand hand(session);
  session.world().repeat<geometry_msgs::WrenchStamped>("cell/predicted_cf",
                                                       [] { return std::optional(wrenchMessage(0, 0, 0)); });
  for (const char* node : {"micromanipulator", "force_sensor", "injection_controller", "haptic_bridge"})
    session.add(node, "{diagnostic_period: 0.1}");
  session.run(2);  // the emulated device answers
  hand.moveTo(-0.3, 0.02, 1.5);
  const double end = hand.needle().z();
  EXPECT_GT(end, -0.4e-3);
  EXPECT_TRUE(session.diagnostics().ever("injection_controller: control", "does not follow its set-point"));
  hand.moveTo(hand.z + kBack / LedHand::kScale, 0.02, 1);
  EXPECT_GT(hand.needle().z() - end, kBack - kAhead - 1e-6);
  EXPECT_FALSE(session.diagnostics().ever("injection_controller: inputs", "one pose"));
}

}  // namespace
}  // namespace microinjection
