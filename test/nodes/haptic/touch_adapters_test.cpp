// The two drivers of a Touch, with messages of their own packages.

#include <gtest/gtest.h>

#include <limits>

#include "haptic_world.h"
#include "nodes/haptic/geomagic_messages.h"
#include "nodes/haptic/omni_messages.h"

namespace microinjection {
namespace {

using TouchButtons = std::pair<int, int>;  // clutch, operator present
const Eigen::Vector3d kTouchForce(0.1, 0.2, -0.3);

/// phantom_omni, whose buttons are told on change.
class OmniTest : public testing::Test {
 protected:
  OmniTest() { forces(); }

  void state(double x, double y, double z, bool locked = false) {  // mm
    OmniState message;
    message.pose = poseMessage(x, y, z).pose;
    message.locked = locked;
    device_.driver().repeat("phantom/state", message);
  }
  void good() {
    state(10, 20, -30);
    device_.force(kTouchForce.x(), kTouchForce.y(), kTouchForce.z());
  }
  void press(int grey, int white) {
    OmniButtonEvent event;
    event.grey_button = grey;
    event.white_button = white;
    device_.driver().say("phantom/button", event);
    device_.run(5e-3);
  }
  Probe<OmniFeedback>& forces() { return device_.driver().hear<OmniFeedback>("phantom/force_feedback"); }

  /// Within the time-outs the force is zero, is said again and again, and stays so.
  void expectZeroAndStays(const std::function<void()>& make_bad) {
    good();
    device_.run(5e-3);
    EXPECT_EQ(toVector(forces().newest()->force), kTouchForce);
    make_bad();
    device_.run(0.1);
    forces().clear();
    device_.run(0.1);
    EXPECT_GT(forces().count(), 20U);
    for (const auto& message : forces().all()) EXPECT_EQ(toVector(message->force), Eigen::Vector3d::Zero());
  }

  HapticWorld device_{{"hand.device:=omni"}};
};

TEST_F(OmniTest, MillimetresBecomeMetres) {
  good();
  device_.run(5e-3);
  EXPECT_TRUE(device_.hand().isApprox(Eigen::Vector3d(0.01, 0.02, -0.03), 1e-12));
}

TEST_F(OmniTest, ButtonsAreKeptUntilTheyChange) {
  good();
  for (const auto& [grey, white] : {TouchButtons(1, 0), TouchButtons(0, 1), TouchButtons(1, 1), TouchButtons(0, 0)}) {
    press(grey, white);
    EXPECT_EQ(device_.buttons(), TouchButtons(grey, white));
    device_.run(1);
    EXPECT_EQ(device_.buttons(), TouchButtons(grey, white));
  }
}

TEST_F(OmniTest, TheOperatorOfADeviceThatWasSilentPressesAgain) {
  good();
  press(0, 1);
  EXPECT_EQ(device_.buttons(), TouchButtons(0, 1));
  device_.driver().silence("phantom/state");
  device_.run(0.1);
  EXPECT_EQ(device_.buttons().second, 0);
  good();
  device_.run(0.1);
  EXPECT_FALSE(device_.newestHand().header.stamp.isZero());
  EXPECT_EQ(device_.buttons().second, 0);
  press(0, 0);
  EXPECT_EQ(device_.buttons(), TouchButtons(0, 0));
  press(0, 1);
  EXPECT_EQ(device_.buttons(), TouchButtons(0, 1));
}

/// However long ago the driver has told its buttons.
TEST_F(OmniTest, ButtonsOfTwoNodesLeadNothing) {
  good();
  press(0, 1);
  device_.run(2);
  EXPECT_EQ(device_.buttons(), TouchButtons(0, 1));
  OmniButtonEvent event;
  event.white_button = 1;
  device_.world().say("phantom/button", event);
  device_.run(1.5);
  EXPECT_TRUE(device_.isSilent());
  EXPECT_TRUE(
      device_.diagnostics().ever("haptic_device: device", "phantom/button is sent by two nodes, /driver and /world"))
      << device_.diagnostics().text("haptic_device: device");
  device_.world().hangUp("phantom/button");
  device_.run(0.6);
  EXPECT_EQ(device_.buttons().second, 0) << "it must be pressed anew";
  press(0, 1);
  EXPECT_EQ(device_.buttons(), TouchButtons(0, 1));
}

/// The driver turns `locked` over at each press of the white button: locked at every second one.
TEST_F(OmniTest, TheLockThatEachPressTurnsOverIsNoClutch) {
  good();
  for (const bool locked : {true, false, true}) {
    state(10, 20, -30, locked);
    press(0, 1);
    device_.run(0.05);
    EXPECT_EQ(device_.buttons(), TouchButtons(0, 1));
    press(0, 0);
    EXPECT_EQ(device_.buttons(), TouchButtons(0, 0));
  }
}

TEST_F(OmniTest, WithoutAFreshForceNoneIsRendered) {
  expectZeroAndStays([&] { device_.silenceForce(); });
  expectZeroAndStays([&] { device_.force(NAN, 0, 0); });
}

TEST_F(OmniTest, ASilentOrSenselessDeviceGetsNoForce) {
  expectZeroAndStays([&] { device_.driver().silence("phantom/state"); });
  EXPECT_TRUE(device_.isSilent());
  expectZeroAndStays([&] { state(INFINITY, 0, 0); });
  EXPECT_TRUE(device_.isSilent());
}

/// ros_geomagic, which tells its buttons with each pose.
class GeomagicTest : public testing::Test {
 protected:
  GeomagicTest() { forces(); }

  void good(int grey = 0, int white = 0) {
    device_.driver().repeat("Geomagic/pose", poseMessage(10, 20, -30));  // mm
    device_.driver().repeat("Geomagic/joy", joyMessage({grey, white}));
    device_.force(kTouchForce.x(), kTouchForce.y(), kTouchForce.z());
    device_.run(0.05);
  }
  Probe<DeviceFeedback>& forces() { return device_.driver().hear<DeviceFeedback>("Geomagic/force_feedback"); }
  Eigen::Vector3d rendered() { return toVector(forces().newest()->force); }

  HapticWorld device_{{"hand.device:=geomagic"}};
};

TEST_F(GeomagicTest, MillimetresBecomeMetres) {
  good();
  EXPECT_TRUE(device_.hand().isApprox(Eigen::Vector3d(0.01, 0.02, -0.03), 1e-12));
}

/// Its driver reads three without asking.
TEST_F(GeomagicTest, EachForceHasThreeLocks) {
  good();
  EXPECT_EQ(rendered(), kTouchForce);
  for (const auto& message : forces().all()) EXPECT_EQ(message->lock, std::vector<std::uint8_t>({0, 0, 0}));
}

TEST_F(GeomagicTest, ClutchAndOperatorAreItsTwoButtons) {
  for (const auto& [grey, white] :
       {TouchButtons(1, 0), TouchButtons(0, 1), TouchButtons(1, 1), TouchButtons(0, 0), TouchButtons(0, 1)}) {
    good(grey, white);
    EXPECT_EQ(device_.buttons(), TouchButtons(grey, white));
  }
}

TEST_F(GeomagicTest, WithoutButtonsTheClutchIsPressedAndTheOperatorGone) {
  good(0, 1);
  device_.driver().silence("Geomagic/joy");
  device_.run(0.2);
  EXPECT_FALSE(device_.newestHand().header.stamp.isZero());
  EXPECT_EQ(device_.buttons(), TouchButtons(1, 0));
  good(0, 1);
  EXPECT_EQ(device_.buttons(), TouchButtons(0, 1));
  device_.driver().repeat("Geomagic/joy", sensor_msgs::Joy());
  device_.run(0.05);
  EXPECT_EQ(device_.buttons(), TouchButtons(1, 0));
}

TEST_F(GeomagicTest, WithoutDeviceOrForceNoneIsRendered) {
  good();
  device_.driver().silence("Geomagic/pose");
  device_.run(0.2);
  EXPECT_EQ(rendered(), Eigen::Vector3d::Zero());
  EXPECT_TRUE(device_.isSilent());
  good();
  EXPECT_EQ(rendered(), kTouchForce);
  device_.silenceForce();
  device_.run(0.2);
  EXPECT_EQ(rendered(), Eigen::Vector3d::Zero());
}

}  // namespace
}  // namespace microinjection
