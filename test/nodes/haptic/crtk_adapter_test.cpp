// Drivers that speak CRTK: an arm of dVRK and a Falcon.

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <std_msgs/Bool.h>

#include "cell_microinjection/OperatingState.h"
#include "haptic_world.h"

namespace microinjection {
namespace {

constexpr char kArm[] = "MTMR/measured_cp", kArmForce[] = "MTMR/body/servo_cf", kArmState[] = "MTMR/operating_state";
constexpr char kPedal[] = "console/clutch", kHead[] = "console/operator_present";
constexpr const char* kArmSettings[] = {"MTMR/body/set_cf_orientation_absolute", "MTMR/use_gravity_compensation"};
using Buttons = std::pair<int, int>;  // clutch, operator present

cell_microinjection::OperatingState armState(const std::string& name, bool homed = true) {
  cell_microinjection::OperatingState state;
  state.state = name;
  state.is_homed = homed;
  return state;
}

/// The driver tells position and force again and again; buttons and state when they change.
class DvrkTest : public testing::TestWithParam<std::string> {
 protected:
  DvrkTest() {
    device_.driver().hear<geometry_msgs::WrenchStamped>(kArmForce);
    for (const char* topic : kArmSettings) device_.driver().hear<std_msgs::Bool>(topic);
  }

  void arm(double x, double y, double z) {
    if (GetParam() == "pose") return device_.driver().repeat(kArm, poseMessage(x, y, z, "HRSV"));
    geometry_msgs::TransformStamped message;
    message.header.frame_id = "HRSV";
    message.transform.translation = toMessage<geometry_msgs::Vector3>({x, y, z});
    message.transform.rotation.w = 1;
    device_.driver().repeat(kArm, message);
  }
  void press(const char* topic, int button) { device_.driver().sayNow(topic, joyMessage({button})); }

  void begin() {
    arm(0.01, 0.02, -0.03);
    device_.force(0.1, 0.2, -0.3);
    device_.run(0.3);
    press(kPedal, 0);
    press(kHead, 1);
    device_.driver().sayNow(kArmState, armState("ENABLED"));
    device_.run(0.03);
    ASSERT_EQ(device_.buttons(), Buttons(0, 1));
    ASSERT_EQ(rendered(), Eigen::Vector3d(0.1, 0.2, -0.3));
  }
  const Probe<geometry_msgs::WrenchStamped>& forces() {
    return device_.driver().hear<geometry_msgs::WrenchStamped>(kArmForce);
  }
  Eigen::Vector3d rendered() { return toVector(forces().newest()->wrench.force); }

  HapticWorld device_{{"hand.device:=dvrk", "hand.position_type:=" + GetParam()}};
};

/// Not even zero: the first one frees the arm, which would then fall.
TEST_P(DvrkTest, NoForceBeforeItsSettings) {
  device_.force(0.1, 0.2, -0.3);
  device_.run(0.3);
  EXPECT_EQ(forces().count(), 0U) << "who the driver is shows by its positions only";
  arm(0.01, 0.02, -0.03);
  device_.run(0.19);
  EXPECT_EQ(forces().count(), 0U) << "the settings need their time";
  device_.run(0.03);
  EXPECT_GT(forces().count(), 0U);
}

TEST_P(DvrkTest, BothSwitchesAreSet) {
  begin();
  for (const char* topic : kArmSettings) {
    const auto& heard = device_.driver().hear<std_msgs::Bool>(topic);
    ASSERT_EQ(heard.count(), 1U) << topic;
    EXPECT_TRUE(heard.newest()->data) << topic;
  }
}

TEST_P(DvrkTest, PositionPassesAndTheForceIsInTheFrameOfTheArm) {
  begin();
  EXPECT_TRUE(device_.hand().isApprox(Eigen::Vector3d(0.01, 0.02, -0.03), 1e-12));
  EXPECT_EQ(forces().newest()->header.frame_id, "HRSV");
}

TEST_P(DvrkTest, ATapHoldsNothingDown) {
  begin();
  press(kPedal, 2);
  device_.run(0.03);
  EXPECT_EQ(device_.buttons(), Buttons(0, 1));
  begin();
  press(kHead, 2);
  device_.run(0.03);
  EXPECT_EQ(device_.buttons(), Buttons(0, 0));
}

TEST_P(DvrkTest, ButtonsHoldUntilTheyChangeButNotPastASilentPose) {
  begin();
  device_.run(2);
  EXPECT_EQ(device_.buttons(), Buttons(0, 1));
  device_.driver().silence(kArm);
  device_.run(0.2);
  EXPECT_TRUE(device_.isSilent());
  arm(0.01, 0.02, -0.03);
  device_.run(0.2);
  EXPECT_FALSE(device_.newestHand().header.stamp.isZero());
  EXPECT_EQ(device_.buttons(), Buttons(0, 0));
}

TEST_P(DvrkTest, AnArmThatTakesNoForceHasNoHand) {
  for (const auto& bad : {armState("DISABLED"), armState("PAUSED"), armState("FAULT"), armState("ENABLED", false)}) {
    SCOPED_TRACE(bad.state);
    begin();
    device_.driver().sayNow(kArmState, bad);
    device_.run(0.1);
    EXPECT_TRUE(device_.isSilent());
    EXPECT_EQ(rendered(), Eigen::Vector3d::Zero());
  }
}

TEST_P(DvrkTest, WithoutAFreshForceOrASensibleArmNoneIsRendered) {
  const std::pair<const char*, std::function<void()>> cases[] = {
      {"silent bridge", [&] { device_.silenceForce(); }},
      {"silent arm", [&] { device_.driver().silence(kArm); }},
      {"force that is no number", [&] { device_.force(NAN, 0, 0); }},
      {"place that is no number", [&] { arm(INFINITY, 0, 0); }}};
  for (const auto& [name, make_bad] : cases) {
    SCOPED_TRACE(name);
    begin();
    make_bad();
    device_.run(0.2);
    EXPECT_EQ(rendered(), Eigen::Vector3d::Zero());
  }
}

INSTANTIATE_TEST_SUITE_P(PositionTypes, DvrkTest, testing::Values("pose", "transform"),
                         [](const auto& type) { return type.param; });

constexpr char kFalcon[] = "falcon/measured_cp", kFalconJoy[] = "falcon/joy", kFalconForce[] = "falcon/servo_cf";

/// Two buttons of one Joy, which its driver tells again and again.
class FalconTest : public testing::Test {
 protected:
  FalconTest() { device_.driver().hear<geometry_msgs::WrenchStamped>(kFalconForce); }

  void good(int present, int clutch) {
    device_.driver().repeat(kFalcon, poseMessage(0.01, 0.02, 0.12, "falcon_front"));
    device_.driver().repeat(kFalconJoy, joyMessage({present, clutch, 0, 0}));
    device_.force(0.1, 0.2, -0.3);
    device_.run(0.03);
  }
  const geometry_msgs::WrenchStamped& newestForce() {
    return *device_.driver().hear<geometry_msgs::WrenchStamped>(kFalconForce).newest();
  }

  HapticWorld device_{{"hand.device:=falcon"}};
};

/// Its driver holds the last one for ever, which may be that of an adapter before this one.
TEST_F(FalconTest, ZeroForceIsSaidBeforeTheDriverSaysAnything) {
  device_.run(0.01);
  EXPECT_EQ(toVector(newestForce().wrench.force), Eigen::Vector3d::Zero());
}

TEST_F(FalconTest, ButtonsAreThoseOfTheGrip) {
  for (const auto& [present, clutch] : {Buttons(1, 0), Buttons(1, 1), Buttons(0, 1), Buttons(0, 0), Buttons(1, 0)}) {
    good(present, clutch);
    EXPECT_EQ(device_.buttons(), Buttons(clutch, present));
  }
}

TEST_F(FalconTest, WithoutButtonsTheClutchIsPressedAndTheOperatorGone) {
  for (const bool silent : {true, false}) {
    good(1, 0);
    EXPECT_EQ(device_.buttons(), Buttons(0, 1));
    device_.driver().repeat(kFalconJoy, sensor_msgs::Joy());
    if (silent) device_.driver().silence(kFalconJoy);
    device_.run(0.1);
    EXPECT_FALSE(device_.newestHand().header.stamp.isZero());
    EXPECT_EQ(device_.buttons(), Buttons(1, 0));
  }
}

/// It takes no other.
TEST_F(FalconTest, TheForceIsInTheFrameOfTheDriver) {
  good(1, 0);
  EXPECT_EQ(toVector(newestForce().wrench.force), Eigen::Vector3d(0.1, 0.2, -0.3));
  EXPECT_EQ(newestForce().header.frame_id, "falcon_front");
}

}  // namespace
}  // namespace microinjection
