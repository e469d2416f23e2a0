#include "rviz/tip_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace microinjection {
namespace {

/// rviz's frames, with the tip 80 um above the origin and turned by 90 degrees about z at second 10.
class TipPoseTest : public testing::Test {
 protected:
  TipPoseTest() {
    geometry_msgs::TransformStamped frame;
    frame.header.frame_id = "world";
    frame.header.stamp = ros::Time(10);
    frame.child_frame_id = "needle_tip";
    frame.transform.translation.z = 80e-6;
    frame.transform.rotation.z = frame.transform.rotation.w = std::sqrt(0.5);
    frames_.setTransform(frame, "test");
  }
  static constexpr double kAnyAge = std::numeric_limits<double>::infinity();

  tf2_ros::Buffer frames_;
};

TEST_F(TipPoseTest, IsThatOfTheTipInTheWorld) {
  const auto pose = tipPose(frames_, ros::Time(10.4), 0.5);
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->translation() - Eigen::Vector3d(0, 0, 80e-6)).norm(), 1e-15);
  EXPECT_LT((pose->linear().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST_F(TipPoseTest, AnOldOneIsNone) {
  EXPECT_FALSE(tipPose(frames_, ros::Time(10.6), 0.5));
  EXPECT_TRUE(tipPose(frames_, ros::Time(1000), kAnyAge));
}

TEST(TipPose, NoneIsKnownBeforeTheFirstFrame) {
  EXPECT_FALSE(tipPose(tf2_ros::Buffer(), ros::Time(10), std::numeric_limits<double>::infinity()));
}

}  // namespace
}  // namespace microinjection
