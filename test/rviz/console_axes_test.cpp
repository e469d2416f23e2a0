#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "console_bench.h"
#include "rviz/axes_box.h"

namespace microinjection {
namespace {

/// The axes of a haptic device are calibrated from the console alone, by three motions of the hand and the mouse.
/// Nobody controls the needle.
class ConsoleAxesTest : public testing::Test {
 protected:
  static constexpr double kReach = 0.04;  // m of a motion

  ConsoleAxesTest() {
    move(0, 0, 0);
    session_.world().repeat("haptic/clutch", joyMessage({0}));
    session_.add("haptic_bridge", "{axes_file: " + file_.string() + "}");
    bench_.run(2);
  }

  void move(double x, double y, double z) {
    session_.world().repeat("haptic/measured_cp", poseMessage(x, y, z, "haptic"));
    session_.run(0.2);
  }
  WindowUser& user() { return bench_.user(); }
  /// The buttons below the commands.
  std::set<std::string> offered() {
    std::set<std::string> labels = user().allOffered();
    for (const char* command : {"Enable", "Home", "Approach", "Indent", "Inject", "Withdraw", "Disable"})
      labels.erase(command);
    return labels;
  }
  std::string report() { return WindowUser::lampIn(*user().shown<AxesBox>().at(0)).first; }
  std::string written() {
    if (!std::filesystem::exists(file_)) return "";
    return YAML::LoadFile(file_)["haptic_bridge"]["device_axes"].as<std::string>();
  }
  /// Presses Axes. @returns what it will do next
  std::string step() {
    user().click("Axes");
    bench_.run(0.2);
    return user().beside("Axes");
  }

  VirtualSession session_{{"hand.device:=external", "hand.require_operator:=false"}};
  std::filesystem::path file_ = session_.folder() / "device_axes_of_the_test.yaml";
  ConsoleBench bench_{session_, "axes"};
};

using Labels = std::set<std::string>;

TEST_F(ConsoleAxesTest, ThreeMotionsAndTheirUndo) {
  EXPECT_EQ(offered(), (Labels{"Axes", "Undo"})) << "End has nothing to end";
  EXPECT_EQ(report(), "grey");
  EXPECT_EQ(step(), "move the hand right, press");
  EXPECT_EQ(offered(), (Labels{"Axes", "Undo", "End"}));
  EXPECT_EQ(report(), "yellow");
  // The hand has not moved.
  EXPECT_EQ(step(), "move the hand right, press");
  EXPECT_EQ(report(), "red");
  move(0, -kReach, 0);
  EXPECT_EQ(step(), "move the hand away, press");
  EXPECT_EQ(report(), "yellow");
  move(kReach, -kReach, 0);
  EXPECT_EQ(step(), "move the hand up, press");
  EXPECT_EQ(written(), "");
  move(kReach, -kReach, kReach);
  EXPECT_EQ(step(), "begins; then right, away, up");
  EXPECT_EQ(written(), "-y x z");
  EXPECT_EQ(report(), "green");
  EXPECT_EQ(offered(), (Labels{"Axes", "Undo"}));
  user().click("Undo");
  bench_.run(0.2);
  EXPECT_EQ(written(), "x y z");
}

TEST_F(ConsoleAxesTest, EndLeavesTheAxesAlone) {
  step();
  move(0, -kReach, 0);
  EXPECT_EQ(step(), "move the hand away, press");
  user().click("End");
  bench_.run(0.2);
  EXPECT_EQ(user().beside("Axes"), "begins; then right, away, up");
  EXPECT_EQ(written(), "");
}

TEST_F(ConsoleAxesTest, NothingIsOfferedWithoutABridge) {
  session_.executive().kill("haptic_bridge");
  EXPECT_TRUE(bench_.until([&] { return offered().empty(); }, 5));
  EXPECT_EQ(user().beside("Axes"), "no node haptic_bridge");
}

}  // namespace
}  // namespace microinjection
