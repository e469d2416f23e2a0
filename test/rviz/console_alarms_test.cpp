#include <gtest/gtest.h>
#include <std_msgs/Bool.h>

#include "cell_microinjection/LoopState.h"
#include "console_bench.h"
#include "led_hand.h"

namespace microinjection {
namespace {

using cell_microinjection::InjectionStatus;
using cell_microinjection::LoopState;
using cell_microinjection::OperatingState;
using Names = std::set<std::string>;

/// Each alarm of the operator's console, provoked in a chain whose needle follows the test's hand, and what its buttons
/// do meanwhile.
class ConsoleAlarmsTest : public testing::Test {
 protected:
  static constexpr double kAtCell = -30e-3;  // m of the hand: 2 um above the cell
  static constexpr double kFar = 100e-3;     // m of the hand: through every guard, or out of the cell
  static constexpr double kSpeed = 20e-3;    // m/s of the hand
  static constexpr char kDepthLimit[] = "{depth_limit: 3.0e-6, goal: {depth: 3.0e-6}}";                // m
  static constexpr char kForceLimit[] = "{force_limit: 0.5e-6, goal: {depth: 3.0e-6}}";                // N
  static constexpr char kNeedleSpeedLimit[] = "{needle_speed_limit: 50.0e-6, goal: {depth: 3.0e-6}}";  // m/s

  ConsoleAlarmsTest() {
    bench_.setNeedle([this](double) -> std::optional<Eigen::Isometry3d> {
      const Eigen::Vector3d tip = hand_.needle();
      if (!tip.allFinite()) return std::nullopt;
      return Eigen::Isometry3d(Eigen::Translation3d(tip));
    });
    world().hear<OperatingState>("controller/operating_state");
    world().hear<LoopState>("controller/loop_state");
    world().repeat("haptic/clutch", joyMessage({0}));
    for (const char* node : {"micromanipulator", "force_sensor", "cell_simulator", "injector", "haptic_bridge"})
      session_.add(node);
    // A small picture, seldom, which costs little.
    session_.add("microscope",
                 "{rate: 2, camera: {width: 174, height: 130, pixel_size: 2.0e-6, origin: [86.5, 64.5]}}");
    session_.add("injection_controller", kDepthLimit);
    for (const char* node : {"injection_controller", "haptic_bridge"})
      setParameters(session_, std::string("/") + node, session_.parameters(node, node[0] == 'i' ? kDepthLimit : "{}"));
    bench_.run(2.5);
  }

  WindowUser& user() { return bench_.user(); }
  TestNode& world() { return session_.world(); }
  Executive& nodes() { return session_.executive(); }

  std::string state() { return world().hear<OperatingState>("controller/operating_state").newest()->state; }
  bool untilState(const std::string& wanted) {
    return bench_.until([&] { return state() == wanted; });
  }
  std::string heldBy() {
    const auto* loop = world().hear<LoopState>("controller/loop_state").newest();
    return loop ? loop->hold_reason : "";
  }
  void expectHeldBy(const std::string& reason) {
    EXPECT_NE(heldBy().find(reason), std::string::npos) << "held by: " << heldBy();
  }
  /// Soon these lamps are red, no other one is, and the headline has this colour, and it stays so.
  void expectRed(const Names& lamps, const std::string& headline = "green") {
    const auto right = [&] { return user().lamps("red") == lamps && bench_.headline() == headline; };
    EXPECT_TRUE(bench_.until(right));
    bench_.run(1);
    EXPECT_EQ(user().lamps("red"), lamps);
    EXPECT_EQ(bench_.headline(), headline) << bench_.headlineText();
    EXPECT_EQ(user().lamps().size(), 9u);
  }
  bool untilHeadline(const std::string& colour) {
    return bench_.until([&] { return bench_.headline() == colour; });
  }
  /// @returns the commands that this has sent
  std::vector<std::string> click(const std::string& button) {
    const std::size_t before = bench_.sent().size();
    user().click(button);
    bench_.run(0.1);
    const std::vector<std::string> sent = bench_.sent();
    return {sent.begin() + static_cast<std::ptrdiff_t>(before), sent.end()};
  }
  void expectClickLeadsTo(const std::string& button, const std::string& wanted) {
    ASSERT_TRUE(bench_.until([&] { return user().offered(button); })) << button << ": " << user().beside(button);
    EXPECT_EQ(click(button).size(), 1u);
    EXPECT_TRUE(untilState(wanted)) << button << ", " << state();
  }
  void stop() {
    EXPECT_EQ(click("STOP"), std::vector<std::string>{"pause"});
    EXPECT_TRUE(untilState("PAUSED")) << state();
  }
  /// The controller's process has died and is started again.
  void restartController(const std::string& changes) {
    const YAML::Node parameters = session_.parameters("injection_controller", changes);
    setParameters(session_, "/injection_controller", parameters);
    nodes().restart("injection_controller", parameters);
    ASSERT_TRUE(untilState("ENABLED"));
    ASSERT_TRUE(untilHeadline("green")) << bench_.headlineText();
  }
  void expectFollows(double goal) {
    const double begin = hand_.needle().z();
    hand_.moveTo(goal, kSpeed);
    EXPECT_GT(std::abs(hand_.needle().z() - begin), 0.5e-6);
  }
  /// From where the hand is: what it did while the needle was held has displaced it from the needle.
  void pressDown() {
    hand_.moveTo(hand_.z - kFar, kSpeed);
    bench_.run(0.2);
  }

  VirtualSession session_{{"cell:=mouse_oocyte_pipette", "hand.device:=external", "hand.require_operator:=false",
                           "camera.source:=sim", "display.markers:=false",
                           "overrides.haptic_bridge.timeouts.hand_unchanged:=0"}};
  ConsoleBench bench_{session_, "teleoperate"};
  LedHand hand_{session_};
};

TEST_F(ConsoleAlarmsTest, ASessionInOrderHasNone) {
  expectRed({});
  EXPECT_EQ(user().lamps("grey"), Names{"Switch"}) << "there is none";
  EXPECT_EQ(user().lamps("green").count("Needle"), 1u);
  EXPECT_EQ(user().lamps("green").count("Clutch"), 1u);
}

TEST_F(ConsoleAlarmsTest, DevicesThatTheNeedleDoesNotNeed) {
  nodes().freeze("force_sensor");
  nodes().freeze("microscope");
  nodes().kill("injector");
  expectRed({"Sensor", "Camera", "Injector"});
  expectFollows(kAtCell);
  nodes().thaw("force_sensor");
  nodes().thaw("microscope");
  nodes().restart("injector");
  expectRed({});
}

TEST_F(ConsoleAlarmsTest, ASilentHand) {
  hand_.silent = true;
  EXPECT_TRUE(bench_.until([&] { return user().lamps()["Needle"] == "yellow"; }));
  hand_.silent = false;
  EXPECT_TRUE(bench_.until([&] { return user().lamps()["Needle"] == "green"; }));
}

TEST_F(ConsoleAlarmsTest, APressedClutch) {
  world().repeat("haptic/clutch", joyMessage({1}));
  EXPECT_TRUE(bench_.until([&] { return user().lamps()["Clutch"] == "yellow"; }));
  EXPECT_EQ(user().lamps()["Needle"], "yellow");
}

/// The virtual microscope has nothing to show without one.
TEST_F(ConsoleAlarmsTest, ASimulatorThatHangs) {
  nodes().freeze("cell_simulator");
  expectRed({"Cell", "Camera"}, "yellow");
  expectHeldBy("no valid force");
  stop();
  expectClickLeadsTo("Resume", "ENABLED");
  expectRed({"Cell", "Camera"}, "yellow");
  nodes().thaw("cell_simulator");
  expectRed({});
}

TEST_F(ConsoleAlarmsTest, ASimulatorAndABridgeThatDie) {
  nodes().kill("cell_simulator");
  nodes().kill("haptic_bridge");
  expectRed({"Needle", "Hand", "Cell", "Camera"}, "yellow");
  expectClickLeadsTo("Disable", "DISABLED");
  nodes().restart("cell_simulator");
  nodes().restart("haptic_bridge");
  expectClickLeadsTo("Enable", "ENABLED");
  expectRed({});
}

TEST_F(ConsoleAlarmsTest, ARigThatHangs) {
  nodes().freeze("micromanipulator");
  expectRed({"Rig"}, "yellow");
  expectHeldBy("no valid needle position");
  nodes().thaw("micromanipulator");
  expectRed({});
}

TEST_F(ConsoleAlarmsTest, TheGuardOfTheDepth) {
  EXPECT_EQ(user().guard("Depth"), "empty");
  pressDown();
  EXPECT_EQ(user().guard("Depth"), "red");
  EXPECT_EQ(user().guard("Force"), "green");
  EXPECT_EQ(bench_.headline(), "yellow");
  expectHeldBy("depth past the touch");
  stop();
  expectClickLeadsTo("Resume", "ENABLED");
  const double begin = hand_.needle().z();
  hand_.moveTo(hand_.z + kFar, kSpeed);  // the only way that is left
  EXPECT_TRUE(untilHeadline("green")) << bench_.headlineText();
  EXPECT_NE(user().guard("Depth"), "red");
  EXPECT_GT(hand_.needle().z() - begin, 20e-6);
}

TEST_F(ConsoleAlarmsTest, AControllerThatDiesAndTheGuardOfTheForce) {
  nodes().kill("injection_controller");
  EXPECT_TRUE(untilHeadline("red"));
  EXPECT_EQ(user().allOffered(), Names());
  restartController(kForceLimit);
  pressDown();
  EXPECT_EQ(user().guard("Force"), "red");
  EXPECT_NE(user().guard("Depth"), "red");
  EXPECT_EQ(bench_.headline(), "yellow");
  expectHeldBy("force along the pipette");
  expectClickLeadsTo("Disable", "DISABLED");
  EXPECT_TRUE(untilHeadline("grey"));
}

TEST_F(ConsoleAlarmsTest, ANeedleThatIsTooFast) {
  restartController(kNeedleSpeedLimit);
  bench_.run(0.5);
  ASSERT_EQ(heldBy(), "");
  hand_.moveTo(hand_.z + 30e-3, 90e-3);
  EXPECT_TRUE(untilState("FAULT"));
  EXPECT_TRUE(untilHeadline("red"));
  // It is red for a controller that was not heard for 1 s, too, and then nothing is offered.
  EXPECT_EQ(user().allOffered(), (Names{"Enable", "Disable"}));
  expectHeldBy("the needle moves at");
  expectClickLeadsTo("Enable", "ENABLED");
  EXPECT_TRUE(untilHeadline("green")) << bench_.headlineText();
}

TEST_F(ConsoleAlarmsTest, AControllerThatHangs) {
  nodes().freeze("injection_controller");
  EXPECT_TRUE(untilHeadline("red"));
  EXPECT_EQ(user().allOffered(), Names());
  EXPECT_EQ(click("STOP"), std::vector<std::string>{"disable"});
  nodes().thaw("injection_controller");
  EXPECT_TRUE(untilState("DISABLED"));
  EXPECT_TRUE(untilHeadline("grey"));
}

/// Without such a network there are no such buttons.
TEST_F(ConsoleAlarmsTest, TheCableOfAnEmulatedNetwork) {
  EXPECT_FALSE(user().shows("Unplug") || user().shows("Plug in"));
  std::vector<bool> said;
  const Subscription heard = world().bus().subscribe<std_msgs::Bool>(
      "link/plugged", 10, [&](const auto& delivery) { said.push_back(delivery.message->data); });
  session_.add("link_emulator", "link_emulator", YAML::Load("{delay: 0.0, jitter: 0.0, loss: 0.0, seed: 1}"));
  bench_.run(0.3);
  // A console that has just started does not know whether the cable is plugged in.
  EXPECT_TRUE(user().offered("Unplug") && user().offered("Plug in"));
  for (const bool in : {false, true, false}) {
    click(in ? "Plug in" : "Unplug");
    bench_.run(0.2);
    ASSERT_FALSE(said.empty());
    EXPECT_EQ(said.back(), in);
    EXPECT_EQ(user().offered("Plug in"), !in);
    EXPECT_EQ(user().offered("Unplug"), in);
  }
  EXPECT_EQ(said.size(), 3u);
  nodes().kill("link_emulator");
  bench_.run(0.3);
  EXPECT_FALSE(user().shows("Unplug") || user().shows("Plug in"));
}

}  // namespace
}  // namespace microinjection
