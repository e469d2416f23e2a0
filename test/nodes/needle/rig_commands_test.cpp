#include <gtest/gtest.h>

#include <algorithm>

#include "needle_bench.h"

namespace microinjection {
namespace {

constexpr double kCommandTimeout = 0.1, kSpeedLimit = 200e-6;  // s, m/s, of config/micromanipulator.yaml

/// What cannot be done, or comes too late, moves nothing.
class RigCommands : public testing::Test {
 protected:
  void SetUp() override {
    bench_.servo(poseAt(held_));
    bench_.run(0.7);
    bench_.silence();
    bench_.run(0.003);
    ASSERT_TRUE(isHeld());
  }
  ::testing::AssertionResult isHeld() { return isNear(bench_.needle(), held_, 1e-9); }

  void expectServoRefused(const geometry_msgs::PoseStamped& pose, const std::string& why) {
    SCOPED_TRACE(why);
    bench_.session.diagnostics().clear();
    bench_.servo(pose);
    bench_.run(0.3);
    bench_.silence();
    EXPECT_TRUE(isHeld());
    EXPECT_NE(bench_.level(), 0);
    EXPECT_TRUE(contains(bench_.status(), why));
  }
  template <typename Message>
  void expectRefused(const std::string& topic, const Message& message, const std::string& why) {
    SCOPED_TRACE(why);
    const int before = bench_.refused();
    world_.say(topic, message);
    bench_.run(0.2);
    EXPECT_EQ(bench_.refused(), before + 1);
    EXPECT_TRUE(contains(bench_.status(), why));
    EXPECT_TRUE(isHeld());
  }

  const Eigen::Vector3d held_{0, 0, 50e-6};           // m
  const Eigen::Vector3d goal_{20e-6, -10e-6, 70e-6};  // m
  NeedleBench bench_;
  TestNode& world_ = bench_.world;
};

TEST_F(RigCommands, SetPointsOutOfReachAreRefusedWithTheReason) {
  expectServoRefused(poseMessage(0, 0, NAN), "not a valid pose in world");
  expectServoRefused(poseMessage(0, 0, 40e-6, "camera"), "not a valid pose in world");
  expectServoRefused(poseMessage(1, 0, 0), "manipulator_x = 1 m, allowed [-0.0125, 0.0125] m");
  geometry_msgs::PoseStamped tilted = poseMessage(0, 0, 40e-6);
  tilted.pose.orientation.x = 0.6;
  tilted.pose.orientation.w = 0.8;
  expectServoRefused(tilted, "orientation differs");
}

TEST_F(RigCommands, AVelocityThatIsStaleStopsTheNeedle) {
  constexpr double kSpeed = 50e-6;  // m/s
  world_.repeat("needle/servo_cv", velocityMessage(kSpeed, "world"));
  ASSERT_TRUE(bench_.until([&] { return bench_.needle().x() > 1e-6; }, 1));
  world_.silence("needle/servo_cv");
  const double silent = bench_.needle().x();
  bench_.run(0.3);
  EXPECT_NEAR(bench_.needle().x() - silent, kSpeed * kCommandTimeout, 5e-3 * kSpeed);
  EXPECT_EQ(bench_.strays(0.3), 0);
}

TEST_F(RigCommands, WhatIsNotFiniteOrInAnotherFrameIsRefused) {
  expectRefused("needle/move_cp", poseAt(goal_, "camera"), "move_cp refused: not a valid pose");
  expectRefused("needle/move_cp", poseMessage(20e-6, NAN, 70e-6), "move_cp refused: not a valid pose");
  expectRefused("needle/servo_cv", velocityMessage(INFINITY), "servo_cv refused: not a valid velocity");
  expectRefused("needle/servo_cv", velocityMessage(50e-6, "camera"), "servo_cv refused: not a valid velocity");
}

/// CRTK: stamp and frame of a command may be empty.
TEST_F(RigCommands, WhatHasNoStampIsTakenAsOfItsArrival) {
  world_.say("needle/servo_cv", velocityMessage(50e-6));
  bench_.run(0.3);
  EXPECT_NEAR(bench_.needle().x(), 50e-6 * kCommandTimeout, 0.2e-6);
  world_.say("needle/move_cp", poseAt(goal_, ""));
  EXPECT_TRUE(bench_.until([&] { return bool(isNear(bench_.needle(), goal_, 1e-9)); }, 1));
}

/// By a second and more, up to the last stamp that there is.
TEST_F(RigCommands, StampsThatAreAheadAreRefused) {
  bench_.run(0.2);
  for (const double ahead : {30.0, 3600.0, 0x1p31 + 1, 0x1p32 - 2}) {
    SCOPED_TRACE(ahead);
    const auto seconds = static_cast<std::uint32_t>(std::min(bench_.session.now().toSec() + ahead, 0x1p32 - 1));
    geometry_msgs::PoseStamped move = poseAt(goal_);
    geometry_msgs::TwistStamped velocity = velocityMessage(50e-6, "world");
    move.header.stamp = velocity.header.stamp = ros::Time(seconds, 999999999);
    bench_.session.diagnostics().clear();
    world_.say("needle/move_cp", move);
    world_.say("needle/servo_cp", move);
    world_.say("needle/servo_cv", velocity);
    bench_.run(0.2);
    for (const std::string topic : {"needle/move_cp", "needle/servo_cp", "needle/servo_cv"})
      EXPECT_TRUE(bench_.session.diagnostics().ever(kNeedleInputs, topic + ": refused, its stamp is")) << topic;
    EXPECT_TRUE(isHeld());
  }
  EXPECT_TRUE(bench_.session.executive().runs("micromanipulator"));
}

/// Whoever commands, and however far the target leaps.
TEST_F(RigCommands, ServoKeepsTheSpeedLimit) {
  bench_.poses.clear();
  bench_.servo(poseMessage(0, 0, 150e-6));
  bench_.run(0.3);
  bench_.silence();
  double fastest = 0;  // m/s
  for (std::size_t i = 1; i < bench_.poses.count(); ++i) {
    const auto &before = *bench_.poses.all()[i - 1], &now = *bench_.poses.all()[i];
    const double dt = secondsBetween(before.header.stamp, now.header.stamp);
    fastest = std::max(fastest, std::abs(now.pose.position.z - before.pose.position.z) / dt);
  }
  EXPECT_LT(fastest, kSpeedLimit * 1.001);
  EXPECT_GT(fastest, kSpeedLimit * 0.99);
  bench_.run(0.2);
  const Eigen::Vector3d rested = bench_.needle();
  world_.repeat("needle/servo_cv", velocityMessage(250e-6, "world"));
  bench_.run(0.2);
  EXPECT_TRUE(contains(bench_.status(), "allowed at most servo_speed_limit"));
  EXPECT_EQ(bench_.needle(), rested);
}

TEST_F(RigCommands, ASecondPublisherIsAFaultUntilEnable) {
  bench_.servo(poseAt(held_));
  bench_.run(0.05);
  bench_.session.addTestNode("stranger").repeat("needle/servo_cp", poseMessage(0, 0, 100e-6));
  ASSERT_TRUE(bench_.until([&] { return bench_.state() == "FAULT"; }, 0.01));
  bench_.run(0.3);
  EXPECT_TRUE(isNear(bench_.needle(), held_, 1e-6));
  EXPECT_EQ(bench_.level(), 2);
  const std::string said = bench_.status(), two = "two nodes command the needle: ";
  EXPECT_TRUE(contains(said, two + "/world and /stranger") || contains(said, two + "/stranger and /world")) << said;
  bench_.session.executive().kill("stranger");
  bench_.silence();
  EXPECT_LE(bench_.strays(0.2), 1e-9);
  EXPECT_EQ(bench_.state(), "FAULT");
  bench_.command("enable");
  EXPECT_TRUE(bench_.until([&] { return bench_.state() == "ENABLED"; }, 0.01));
}

/// Whatever it commands.
TEST_F(RigCommands, ASecondPublisherOfAVelocityOrAMoveIsAFault) {
  for (const std::string topic : {"needle/servo_cv", "needle/move_cp"}) {
    SCOPED_TRACE(topic);
    bench_.servo(poseAt(held_));
    bench_.run(0.05);
    TestNode& stranger = bench_.session.addTestNode("stranger_" + topic.substr(7));
    if (topic == "needle/move_cp") {
      stranger.repeat(topic, poseAt(goal_));
    } else {
      stranger.repeat(topic, velocityMessage(50e-6, "world"));
    }
    EXPECT_TRUE(bench_.until([&] { return bench_.state() == "FAULT"; }, 0.01));
    stranger.silence(topic);
    bench_.silence();
    bench_.run(0.3);
    EXPECT_TRUE(isNear(bench_.needle(), held_, 1e-6));
    EXPECT_TRUE(contains(bench_.status(), "two nodes command the needle"));
    bench_.command("enable");
    ASSERT_TRUE(bench_.until([&] { return bench_.state() == "ENABLED"; }, 0.01));
    bench_.run(0.2);
  }
}

TEST_F(RigCommands, AMoveArrives) {
  bench_.move(goal_);
  EXPECT_TRUE(bench_.until([&] { return bench_.busy(); }, 0.005));
  EXPECT_TRUE(bench_.until([&] { return !bench_.busy(); }, 1));
  EXPECT_TRUE(isNear(bench_.needle(), goal_, 1e-9));
}

}  // namespace
}  // namespace microinjection
