#include <gtest/gtest.h>

#include "cell/model/scene.h"
#include "cell_microinjection/LoopState.h"
#include "led_hand.h"

namespace microinjection {
namespace {

constexpr double kGain = 2e5;    // config/haptic_bridge.yaml
constexpr double kScale = 1e-3;  // of the hand's motion
constexpr double kGap = 32e-6;   // m, from where the needle starts to the cell

/// Hand to needle to cell to hand.
class ChainTest : public testing::Test {
 protected:
  ChainTest() {
    session_.add("micromanipulator");
    session_.add("force_sensor");
    session_.add("cell_simulator");
    session_.add("injection_controller", "{diagnostic_period: 0.1, injector: false}");
    session_.add("haptic_bridge", "{diagnostic_period: 0.1}");
    session_.run(0.15);  // the loop closes and its ramp is over
  }

  void press(double depth = 4e-6) { hand_.moveTo(-(kGap + depth) / kScale); }
  const cell_microinjection::CellState& cell() {
    return *session_.world().hear<cell_microinjection::CellState>("cell/state").newest();
  }
  template <typename Message>
  const Message& newest(const std::string& topic) {
    return *session_.world().hear<Message>(topic).newest();
  }
  void expectHeld(const std::string& reason) {
    const Eigen::Vector3d held = hand_.needle();
    hand_.z -= 5e-3;  // it would go deeper
    session_.run(1.5);
    EXPECT_LT((hand_.needle() - held).norm(), 1e-9);
    EXPECT_EQ(hand_.force().norm(), 0);
    EXPECT_NE(session_.diagnostics().text("haptic_bridge: loop").find(reason), std::string::npos);
    EXPECT_NE(session_.diagnostics().text("injection_controller: control").find("needle held"), std::string::npos);
    const auto& bridge = newest<cell_microinjection::LoopState>("haptic/loop_state");
    EXPECT_FALSE(bridge.follows);
    EXPECT_NE(bridge.hold_reason.find(reason), std::string::npos);
    EXPECT_FALSE(newest<cell_microinjection::LoopState>("controller/loop_state").follows);
    // The hand is back, 5 mm deeper: the needle must not leap there, the force must not kick.
    hand_.silent = false;
    hand_.instead.reset();
    session_.run(0.006);
    EXPECT_LT((hand_.needle() - held).norm(), 1e-9);
    session_.run(0.2);
    EXPECT_GT(hand_.force().z(), 0.05);
  }

  VirtualSession session_{{"cell:=" + testFile("scenes/coarse_oocyte.yaml"), "model:=live", "hand.device:=external",
                           "hand.require_operator:=false"}};
  LedHand hand_{session_};
};

TEST_F(ChainTest, NoForceBeforeTheTouch) {
  hand_.moveTo(-(kGap - 1e-6) / kScale);
  EXPECT_LT((hand_.needle() - Eigen::Vector3d(0, 0, 29e-6)).norm(), 1e-9);
  EXPECT_EQ(hand_.force().norm(), 0);
}

TEST_F(ChainTest, TouchIsFeltAndReleased) {
  session_.world().hear<cell_microinjection::CellState>("cell/state");
  session_.world().hear<geometry_msgs::WrenchStamped>("cell/predicted_cf");
  session_.world().hear<geometry_msgs::WrenchStamped>("force_sensor/measured_cf");
  press();
  ASSERT_TRUE(cell().in_contact);
  EXPECT_TRUE(cell().converged) << cell().reason;
  EXPECT_NEAR(cell().contact_point.z - cell().indentation, hand_.needle().z(), 1e-9);
  const double predicted = newest<geometry_msgs::WrenchStamped>("cell/predicted_cf").wrench.force.z;
  EXPECT_GT(predicted, 0.3e-6);
  EXPECT_NEAR(hand_.force().z() / (kGain * predicted), 1, 0.01);
  EXPECT_LT(hand_.force().head<2>().norm(), 0.05 * hand_.force().z());
  EXPECT_NEAR(newest<geometry_msgs::WrenchStamped>("force_sensor/measured_cf").wrench.force.z, predicted,
              0.01 * predicted + 80e-9);
  hand_.moveTo(-(kGap - 3e-6) / kScale);
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

}  // namespace
}  // namespace microinjection
