#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "bridge_world.h"
#include "cell_microinjection/CalibrateAxes.h"
#include "cell_microinjection/OperatingState.h"

namespace microinjection {
namespace {

using cell_microinjection::CalibrateAxes;
using Request = CalibrateAxes::Request;
using Place = Eigen::Vector3d;  // of the hand, m

const Place kZero = Place::Zero();

/// The axes of a device are calibrated while the needle is held.
class DeviceAxesTest : public testing::Test {
 protected:
  DeviceAxesTest() { moveTo(kZero, 0.2); }

  void moveTo(const Place& hand, double seconds, int clutch = 0, const std::string& state = "ENABLED") {
    bridge_.world().repeat(kHand, poseMessage(hand.x(), hand.y(), hand.z(), "haptic"));
    bridge_.world().repeat(kClutch, joyMessage({clutch}));
    cell_microinjection::OperatingState operating;
    operating.state = state;
    bridge_.world().repeat("controller/operating_state", operating);
    bridge_.run(seconds);
  }
  CalibrateAxes::Response step(int action, const Place& hand, int clutch = 0, const std::string& state = "ENABLED") {
    moveTo(hand, 0.1, clutch, state);
    Request request;
    request.action = static_cast<std::uint8_t>(action);
    return bridge_.session().call<CalibrateAxes>("/haptic_bridge/calibrate_axes", request);
  }
  Eigen::Vector3d forceAfter(const Place& hand) {
    moveTo(hand, 0.6);
    return bridge_.force();
  }
  /// With the clutch released.
  void expectHeld(const Place& hand) {
    EXPECT_EQ(forceAfter(hand).norm(), 0);
    EXPECT_FALSE(bridge_.follows());
  }
  void expectForce(const Eigen::Vector3d& expected) { EXPECT_LT((forceAfter(kZero) - expected).norm(), 1e-12); }
  void expectFile(const CalibrateAxes::Response& answer, const std::string& axes) {
    EXPECT_EQ(answer.file.find(bridge_.session().folder().string()), 0u) << answer.file;
    const YAML::Node file = YAML::LoadFile(answer.file);
    ASSERT_EQ(file.size(), 1u);
    ASSERT_EQ(file["haptic_bridge"].size(), 1u);
    EXPECT_EQ(file["haptic_bridge"]["device_axes"].as<std::string>(), axes);
  }

  BridgeWorld bridge_;
};

TEST_F(DeviceAxesTest, AWholeCalibrationAndItsUndo) {
  CalibrateAxes::Response answer = step(Request::BEGIN, kZero);
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("follows the hand"), std::string::npos) << answer.message;
  answer = step(Request::BEGIN, kZero, 1);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.next, "right");
  expectHeld(kZero);
  answer = step(Request::MOTION, {5e-3, 0, 0});
  EXPECT_FALSE(answer.success) << "too short";
  EXPECT_EQ(answer.next, "right");
  EXPECT_TRUE(step(Request::MOTION, {35e-3, 3e-3, 0}).success);
  EXPECT_TRUE(step(Request::MOTION, {35e-3, 3e-3, -30e-3}).success);
  expectHeld({35e-3, 3e-3, -30e-3});
  // The clutch is pressed: the hand must not lead from there.
  answer = step(Request::MOTION, {35e-3, 33e-3, -30e-3}, 1);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.next, "");
  EXPECT_EQ(answer.device_axes, "x -z y");
  EXPECT_NEAR(answer.angle_to_axis, std::atan(0.1), 1e-6);
  expectFile(answer, "x -z y");
  // Up is now the device's y, and the hand leads again.
  expectForce({0, 0.2, 0});
  EXPECT_TRUE(bridge_.follows());

  EXPECT_FALSE(step(Request::UNDO, kZero).success);
  answer = step(Request::UNDO, kZero, 1);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.device_axes, "x y z");
  expectFile(answer, "x y z");
  expectForce({0, 0, 0.2});
}

TEST_F(DeviceAxesTest, AControllerThatIsDisabledLetsItBegin) {
  EXPECT_TRUE(step(Request::BEGIN, kZero, 0, "DISABLED").success);
  expectHeld(kZero);
  EXPECT_TRUE(step(Request::STOP, kZero).success);
  expectForce({0, 0, 0.2});
}

}  // namespace
}  // namespace microinjection
