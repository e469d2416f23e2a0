// A gamepad with the numbers of config/haptic/joy.yaml: its deflection is a place of the hand, and the operator is
// there while the stick is held that was let go first.

#include <gtest/gtest.h>

#include <cmath>

#include "haptic_world.h"

namespace microinjection {
namespace {

class JoyTest : public testing::Test {
 protected:
  struct Stick {
    float x = 0, y = 0, z = 0;
    bool held = true;
    int button = -1;  // that is pressed; -1: none
  };

  void move(const Stick& stick) {
    sensor_msgs::Joy message;
    message.axes = {stick.x, stick.y, 0, 0, stick.z, 0};
    message.buttons.resize(11);
    message.buttons[4] = stick.held ? 1 : 0;
    if (stick.button >= 0) message.buttons[stick.button] = 1;
    device_.driver().repeat("joy", message);
    device_.run(0.03);
  }
  bool present() { return device_.buttons().second == 1; }

  HapticWorld device_{{"hand.device:=joy"}};
};

TEST_F(JoyTest, DeflectionIsAPlaceOfTheHand) {
  move({});
  EXPECT_TRUE(present());
  move({1, -0.5, -1});
  EXPECT_TRUE(device_.hand().isApprox(Eigen::Vector3d(-0.015, -0.0075, -0.015), 1e-6)) << device_.hand();
  EXPECT_TRUE(present());
}

TEST_F(JoyTest, AStickThatIsHeldWhileDeflectedLeadsNothing) {
  move({});
  move({0, 0, -1, false});
  EXPECT_FALSE(present());
  move({0, 0, -1});
  EXPECT_FALSE(present());
  move({});
  EXPECT_TRUE(present());
}

TEST_F(JoyTest, ASilentStickMustBeLetGoAgain) {
  move({});
  move({0, 0, -1});
  EXPECT_TRUE(present());
  device_.driver().silence("joy");
  device_.run(0.19);
  EXPECT_TRUE(present());
  device_.run(0.06);
  EXPECT_TRUE(device_.isSilent());
  move({0, 0, -1});
  EXPECT_FALSE(device_.newestHand().header.stamp.isZero());
  EXPECT_FALSE(present());
}

/// Held still on purpose, as while one looks at the image: at the centre, and deflected by a hand that trembles.
TEST_F(JoyTest, AStickThatIsHeldStillForTenSecondsStillLeads) {
  move({});
  device_.run(10);
  EXPECT_TRUE(present());
  for (int i = 0; i < 200; ++i) {
    move({0, 0, i % 8 < 4 ? -0.5F : -0.504F});  // by a step of its 8 bits
    device_.run(0.02);
    ASSERT_TRUE(present()) << i;
  }
  EXPECT_NEAR(device_.hand().z(), -0.0075, 1e-4);
}

/// The dead-man button is held and nobody touches the sticks: whatever their driver makes of that, the hand rests.
TEST_F(JoyTest, NothingMovesByItself) {
  const float not_finite = std::nanf("");
  const std::pair<const char*, std::vector<std::vector<float>>> drivers[] = {
      {"triggers read 0 until they are moved first, and 1 then", {{0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 1}}},
      {"D mode: the hat is on the last axes", {{0, 0, 0, 0, 0, 0}}},
      {"an axis that is no number", {{0, 0, 0, 0, not_finite, 0}}},
      {"all are no numbers", {std::vector<float>(6, not_finite)}},
      {"the vertical stick is on another axis, a trigger that rests at 1 on this one", {{0, 0, 0, 0, 1, 0}}},
      {"fewer axes", {{0, 0}}},
      {"an axis at its end since the start", {{-1, 0, 0, 0, 0, 0}}}};
  for (const auto& [what, states] : drivers) {
    SCOPED_TRACE(what);
    device_.driver().silence("joy");
    device_.run(0.3);
    for (const std::vector<float>& axes : states) {
      sensor_msgs::Joy message;
      message.axes = axes;
      message.buttons.resize(12);
      message.buttons[4] = 1;
      device_.driver().repeat("joy", message);
      for (int i = 0; i < 30; ++i) {
        device_.run(0.1);
        if (present()) {
          ASSERT_LT(device_.hand().norm(), 1e-9);
        }
      }
    }
  }
}

TEST_F(JoyTest, AButtonIsAWordOnce) {
  move({});
  move({0, 0, 0, true, 0});
  move({});
  move({0, 0, 0, true, 1});
  EXPECT_EQ(device_.commands(), std::vector<std::string>({"inject", "home"}));
}

}  // namespace
}  // namespace microinjection
