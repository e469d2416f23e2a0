// A gamepad with the numbers of config/haptic/joy.yaml: its deflection is a place of the hand, and the operator is
// there while the stick is held that was let go first.

#include <gtest/gtest.h>

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

TEST_F(JoyTest, AButtonIsAWordOnce) {
  move({});
  move({0, 0, 0, true, 0});
  move({});
  move({0, 0, 0, true, 1});
  EXPECT_EQ(device_.commands(), std::vector<std::string>({"inject", "home"}));
}

}  // namespace
}  // namespace microinjection
