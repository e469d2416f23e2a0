// A second manipulator, of the holding pipette: its own topics, DISABLED until enabled, and an obstacle for the needle
// as the needle is one for it.

#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>

#include "needle_bench.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kMouth(0, 0, -28e-6);  // m, of urdf/rig.urdf

class HolderRigTest : public testing::TestWithParam<const char*> {
 protected:
  using Pose = geometry_msgs::PoseStamped;
  using OperatingState = cell_microinjection::OperatingState;

  HolderRigTest() {
    for (const char* node : {"micromanipulator", "holder_rig"}) session_.add(node, "{diagnostic_period: 0.1}");
    EXPECT_TRUE(session_.until([&] { return isNear(holder(), kMouth, 1e-6) && std::isfinite(needle().x()); }));
    session_.run(0.3);
  }
  Eigen::Vector3d needle() const { return placeOf(needles_); }
  Eigen::Vector3d holder() const { return placeOf(holders_); }
  static Eigen::Vector3d placeOf(const Probe<Pose>& poses) {
    return poses.newest() ? NeedleBench::placeOf(*poses.newest()) : Eigen::Vector3d::Constant(NAN);
  }
  Pose holderPose(const Eigen::Vector3d& place) const {
    Pose pose = *holders_.newest();
    pose.pose.position = toMessage<geometry_msgs::Point>(place);
    return pose;
  }
  void moveHolder(const Eigen::Vector3d& place) { session_.world().sayNow("holder_rig/move_cp", holderPose(place)); }
  void moveNeedle(const Eigen::Vector3d& place) { session_.world().sayNow("needle/move_cp", poseAt(place)); }
  void enable() {
    session_.world().command("holder_rig/state_command", "enable");
    ASSERT_TRUE(session_.until([&] { return states_.newest()->state == "ENABLED"; }));
  }
  bool arrives(const Probe<Pose>& poses, const Eigen::Vector3d& place) {
    return session_.until([&] { return isNear(placeOf(poses), place, 0.2e-6); });
  }
  std::string said(const std::string& status) {
    session_.run(0.3);
    return session_.diagnostics().text(status);
  }

  VirtualSession session_{{std::string("holder_rig.name:=") + GetParam()}};
  TestNode& other_ = session_.addTestNode("other");
  Probe<Pose>& needles_ = session_.world().hear<Pose>("needle/measured_cp");
  Probe<Pose>& holders_ = session_.world().hear<Pose>("holder_rig/measured_cp");
  Probe<OperatingState>& states_ = session_.world().hear<OperatingState>("holder_rig/operating_state");
  Probe<OperatingState>& needle_states_ = session_.world().hear<OperatingState>("needle/operating_state");
};

TEST_P(HolderRigTest, StandsStillUntilItIsEnabledWhileTheNeedleMoves) {
  EXPECT_EQ(states_.newest()->state, "DISABLED");
  EXPECT_EQ(needle_states_.newest()->state, "ENABLED");
  moveHolder(kMouth + Eigen::Vector3d(5e-6, 0, 0));
  moveNeedle({5e-6, 0, 70e-6});
  EXPECT_TRUE(arrives(needles_, {5e-6, 0, 70e-6}));
  EXPECT_TRUE(isNear(holder(), kMouth, 0.2e-6));
  EXPECT_TRUE(contains(said("holder_rig: commands"), "DISABLED"));
  EXPECT_EQ(said("holder_rig: inputs"), "all inputs are fresh") << "nobody need stream to it";
  enable();
  moveHolder(kMouth + Eigen::Vector3d(5e-6, -3e-6, 2e-6));
  EXPECT_TRUE(arrives(holders_, kMouth + Eigen::Vector3d(5e-6, -3e-6, 2e-6)));
  EXPECT_TRUE(isNear(needle(), {5e-6, 0, 70e-6}, 0.2e-6)) << "each has topics of its own";
}

TEST_P(HolderRigTest, EachIsAnObstacleForTheOtherWhereItIs) {
  enable();
  const Eigen::Vector3d low(0, 0, -10e-6), up = kMouth + Eigen::Vector3d(0, 0, 20e-6);
  moveNeedle(low);
  ASSERT_TRUE(arrives(needles_, low));
  session_.run(0.1);
  moveHolder(up);
  session_.run(0.5);
  EXPECT_TRUE(isNear(holder(), kMouth, 0.2e-6));
  EXPECT_TRUE(contains(said("holder_rig: commands"), "holding_pipette would"));
  EXPECT_TRUE(contains(said("holder_rig: commands"), "needle_tip"));
  moveHolder(kMouth +
             Eigen::Vector3d(0, 0, 10e-6));  // 8 um below the tip, where a half sphere on the mouth would not fit
  EXPECT_TRUE(arrives(holders_, kMouth + Eigen::Vector3d(0, 0, 10e-6)));
  moveNeedle({0, 0, 40e-6});
  ASSERT_TRUE(arrives(needles_, {0, 0, 40e-6}));
  session_.run(0.1);
  moveHolder(up);
  ASSERT_TRUE(arrives(holders_, up));
  session_.run(0.1);
  moveNeedle(low);
  session_.run(0.5);
  EXPECT_TRUE(isNear(needle(), {0, 0, 40e-6}, 0.2e-6));
  EXPECT_TRUE(contains(said("micromanipulator: commands"), "needle_tip would run into holding_pipette"));
  moveHolder(kMouth);
  ASSERT_TRUE(arrives(holders_, kMouth));
  session_.run(0.1);
  moveNeedle(low);
  EXPECT_TRUE(arrives(needles_, low));
}

TEST_P(HolderRigTest, TwoCommandersAreAFaultOfTheirRigAlone) {
  enable();
  TestNode& world = session_.world();
  world.repeat<Pose>("holder_rig/servo_cp", holderPose(kMouth + Eigen::Vector3d(50e-6, 0, 0)));
  session_.run(0.1);
  other_.sayNow("holder_rig/servo_cp", holderPose(kMouth));
  ASSERT_TRUE(session_.until([&] { return states_.newest()->state == "FAULT"; }, 2));
  EXPECT_TRUE(contains(said("holder_rig: commands"), "two nodes command the holding pipette: /world and /other"));
  EXPECT_EQ(needle_states_.newest()->state, "ENABLED");
}

TEST_P(HolderRigTest, ItsEndIsSaidAndTheNeedleGoesOn) {
  session_.executive().kill("holder_rig");
  EXPECT_TRUE(contains(said("micromanipulator: inputs"), "/holder_rig/measured_cp is stale"));
  EXPECT_TRUE(contains(said("micromanipulator: other manipulator"), "the place of the other manipulator is not known"));
  moveNeedle({5e-6, 0, 70e-6});
  EXPECT_TRUE(arrives(needles_, {5e-6, 0, 70e-6}));
  moveNeedle({0, 0, -40e-6});
  session_.run(0.5);
  EXPECT_TRUE(contains(said("micromanipulator: commands"), "needle_tip would run into holding_pipette"));
}

INSTANTIATE_TEST_SUITE_P(Rigs, HolderRigTest, testing::Values("sim", "emulated_zaber", "emulated_scientifica"));

TEST(HolderRigFrames, TheHoldingPipettesFrameMoves) {
  VirtualSession session{{"holder_rig.name:=sim"}};
  auto& frames = session.world().hear<tf2_msgs::TFMessage>("/tf");
  auto& holders = session.world().hear<geometry_msgs::PoseStamped>("holder_rig/measured_cp");
  session.start();
  session.run(0.5);
  double height = NAN;
  const auto find = [&] {
    for (const auto& message : frames.all())
      for (const auto& frame : message->transforms)
        if (frame.child_frame_id == "holding_stage_z") height = frame.transform.translation.z;
    return height;
  };
  EXPECT_NEAR(find(), 0, 1e-9);
  session.world().command("holder_rig/state_command", "enable");
  session.run(0.1);
  auto pose = *holders.newest();
  pose.pose.position.z -= 10e-6;
  session.world().sayNow("holder_rig/move_cp", pose);
  session.run(1);
  EXPECT_NEAR(find(), -10e-6, 1e-8);
}

}  // namespace
}  // namespace microinjection
