#include <gtest/gtest.h>
#include <std_msgs/Bool.h>

#include "cell_microinjection/CellState.h"
#include "cell_microinjection/LinkPacket.h"
#include "led_hand.h"

namespace microinjection {
namespace {

/// A hand behind a network of 50 to 75 ms and 20 % loss.
class LinkTest : public testing::Test {
 protected:
  static constexpr double kReserve = 1e-3;  // J, passivity/reserve of config/haptic_bridge.yaml
  static constexpr double kTimeout = 0.3;   // s, config/link.yaml
  static constexpr double kDelay = 0.075;   // s, one way at the most

  LinkTest() {
    session_.world().hear<cell_microinjection::CellState>("cell/state");
    session_.world().hear<geometry_msgs::WrenchStamped>("cell/predicted_cf");
    session_.world().hear<cell_microinjection::LinkPacket>("link/hand/received");
    session_.add("teleoperation_follower", "{diagnostic_period: 0.1}");
    session_.start();
    session_.run(3 * kDelay);
  }
  /// In no test the hand is given more energy than the loop may.
  ~LinkTest() override { EXPECT_GT(hand_.lowestEnergy(), -kReserve); }

  void moveTo(double goal, double rest = 0.7) { hand_.moveTo(goal, 0.03, rest); }
  void press() { hand_.press(4e-6, 0.03, 1.5); }
  void plug(bool plugged) {
    std_msgs::Bool message;
    message.data = plugged;
    session_.world().say("link/plugged", message, true);
  }
  double predicted() {
    return session_.world().hear<geometry_msgs::WrenchStamped>("cell/predicted_cf").newest()->wrench.force.z;
  }
  /// s, without a packet at the hand.
  double silence() {
    const auto& received = session_.world().hear<cell_microinjection::LinkPacket>("link/hand/received");
    return (session_.now() - received.arrivals().back()).toSec();
  }

  VirtualSession session_{{"cell:=" + testFile("scenes/coarse_oocyte.yaml"), "model:=live", "hand.device:=external",
                           "hand.require_operator:=false", "link.scheme:=wave", "link.delay:=0.05",
                           "link.jitter:=0.025", "link.loss:=0.2", "sensor.source:=none", "injector:=none",
                           "display.markers:=false", "overrides.haptic_bridge.timeouts.hand_unchanged:=0"}};
  LedHand hand_{session_};
};

TEST_F(LinkTest, NeedleGoesAfterTheHand) {
  moveTo(-10e-3);
  EXPECT_LT((hand_.needle() - Eigen::Vector3d(0, 0, 50e-6)).norm(), 0.1e-6);
  EXPECT_LT(hand_.force().norm(), 0.02);
}

TEST_F(LinkTest, ForceArrivesAndStays) {
  press();
  EXPECT_TRUE(session_.world().hear<cell_microinjection::CellState>("cell/state").newest()->in_contact);
  const double felt = hand_.force().z();
  EXPECT_GT(felt, 0.05);
  EXPECT_NEAR(felt / (LedHand::kForceGain * predicted()), 1, 0.03);  // the force of the cell, not what is left of it
  session_.run(1);
  EXPECT_NEAR(hand_.force().z() / felt, 1, 0.03);
  EXPECT_GT(hand_.energy(), 0);
}

TEST_F(LinkTest, DeadLinkHoldsTheNeedleAndRendersNothingUntilItIsTakenUpWhereTheNeedleIs) {
  press();
  EXPECT_GT(hand_.force().z(), 0.05);
  plug(false);
  ASSERT_TRUE(session_.until([&] { return hand_.force().norm() == 0; }, 1));
  EXPECT_NEAR(silence(), kTimeout, 0.005);
  session_.run(2 * kDelay);
  const Eigen::Vector3d held = hand_.needle();
  moveTo(hand_.z - 5e-3);
  EXPECT_LT((hand_.needle() - held).norm(), 1e-9);
  EXPECT_EQ(hand_.force().norm(), 0);
  const auto* status = session_.diagnostics().of("teleoperation_follower: link");
  ASSERT_TRUE(status);
  EXPECT_EQ(status->level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_NE(status->message.find("needle held"), std::string::npos) << status->message;

  plug(true);
  double lowest = held.z();
  for (int i = 0; i < 2000; ++i) {
    session_.run(1e-3);
    lowest = std::min(lowest, hand_.needle().z());
  }
  EXPECT_GT(lowest, held.z() - 0.1e-6) << "what the hand did meanwhile pushes";
  EXPECT_GT(hand_.force().z(), 0.02);
}

TEST_F(LinkTest, ClutchMovesTheHandAlone) {
  moveTo(-20e-3);
  hand_.clutch(true);
  session_.run(3 * kDelay);
  const Eigen::Vector3d before = hand_.needle();
  moveTo(hand_.z - 20e-3, 0.1);
  EXPECT_LT((hand_.needle() - before).norm(), 1e-9);
  EXPECT_EQ(hand_.force().norm(), 0);
  hand_.clutch(false);
  session_.run(3 * kDelay);
  moveTo(hand_.z + 10e-3);
  EXPECT_LT((hand_.needle() - before - Eigen::Vector3d(0, 0, 10e-6)).norm(), 0.1e-6);
}

/// Into the cell, over a hold and a clutch, and out again.
TEST_F(LinkTest, NoEnergyIsGivenOverAWholeSession) {
  press();
  plug(false);
  session_.run(kTimeout + kDelay);
  moveTo(hand_.z - 5e-3);
  plug(true);
  session_.run(2);
  moveTo(hand_.z + 12e-3);
  hand_.clutch(true);
  session_.run(3 * kDelay);
  moveTo(hand_.z - 20e-3);
  hand_.clutch(false);
  session_.run(3 * kDelay);
  moveTo(hand_.z + 10e-3);
  EXPECT_GT(hand_.energy(), 0);
}

}  // namespace
}  // namespace microinjection
