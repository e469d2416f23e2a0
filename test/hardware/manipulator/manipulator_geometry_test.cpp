#include "hardware/manipulator/manipulator_geometry.h"

#include <gtest/gtest.h>

#include <regex>

#include "base/errors.h"
#include "hardware/manipulator/rig_file.h"

namespace microinjection {
namespace {

/// A rig whose x axis is tilted by 30 degrees about y and whose tip hangs 1 mm below the last stage.
std::string tiltedUrdf(const std::string& z_limit =
                           R"(<limit lower="-1e-3" upper="2e-3" velocity="1e-3" acceleration="0.2" effort="1"/>)") {
  return R"(<robot name="r"><link name="world"/><link name="a"/><link name="b"/><link name="c"/><link name="needle_tip"/>
    <joint name="jx" type="prismatic"><parent link="world"/><child link="a"/><origin xyz="0.1 0 0" rpy="0 0.5235987755982988 0"/>
      <axis xyz="1 0 0"/><limit lower="-1e-3" upper="1e-3" velocity="1e-3" acceleration="0.2" effort="1"/></joint>
    <joint name="jy" type="prismatic"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/>
      <limit lower="-1e-3" upper="1e-3" velocity="1e-3" acceleration="0.2" effort="1"/></joint>
    <joint name="jz" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>)" +
         z_limit + R"(</joint>
    <joint name="tip" type="fixed"><parent link="c"/><child link="needle_tip"/><origin xyz="0 0 -1e-3"/></joint></robot>)";
}

TEST(ManipulatorGeometry, ReadsTheRigAsItsFileSays) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(rigUrdf());
  EXPECT_TRUE(rig.tip(Eigen::Vector3d::Zero()).isApprox(Eigen::Vector3d(0, 0, 60e-6), 1e-12));
  EXPECT_TRUE(rig.tip({1e-6, 2e-6, -3e-6}).isApprox(Eigen::Vector3d(1e-6, 2e-6, 57e-6), 1e-9));
  EXPECT_EQ(rig.axes[2].joint, "manipulator_z");
  EXPECT_GT(rig.axes[0].velocity, 0);
}

TEST(ManipulatorGeometry, FollowsTiltedAxes) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(tiltedUrdf());
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  EXPECT_TRUE(rig.directions.col(0).isApprox(Eigen::Vector3d(c, 0, -s), 1e-9));
  const Eigen::Vector3d start = Eigen::Vector3d(0.1, 0, 0) - 1e-3 * Eigen::Vector3d(s, 0, c);
  EXPECT_TRUE(rig.tip(Eigen::Vector3d::Zero()).isApprox(start, 1e-9));
  EXPECT_TRUE(rig.tip({5e-4, 0, 0}).isApprox(start + 5e-4 * Eigen::Vector3d(c, 0, -s), 1e-9));
}

TEST(ManipulatorGeometry, InverseUndoesForward) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(tiltedUrdf());
  const Eigen::Vector3d joints(3e-4, -7e-4, 1.5e-3);
  EXPECT_LT((rig.joints(rig.tip(joints)) - joints).norm(), 1e-12);
}

TEST(ManipulatorGeometry, NamesTheAxisThatIsOutside) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(tiltedUrdf());
  EXPECT_EQ(rig.outsideTravel({1e-3, -1e-3, 2e-3}), "");
  const std::string reason = rig.outsideTravel({0, 0, 2.1e-3});
  EXPECT_NE(reason.find("jz"), std::string::npos) << reason;
  EXPECT_NE(reason.find("0.0021"), std::string::npos) << reason;
  EXPECT_NE(reason.find("0.002]"), std::string::npos) << reason;
}

TEST(ManipulatorGeometry, ReadsTheAccelerationThatUrdfReadersPassOver) {
  EXPECT_DOUBLE_EQ(ManipulatorGeometry::fromUrdf(tiltedUrdf()).axes[1].acceleration, 0.2);
  for (const std::string& wrong : {"", "acceleration=\"0\"", "acceleration=\"-1\"", "acceleration=\"1 m\"",
                                   "acceleration=\"nan\"", "acceleration=\"\""}) {
    const std::string limit = "<limit lower=\"-1e-3\" upper=\"2e-3\" velocity=\"1e-3\" " + wrong + " effort=\"1\"/>";
    try {
      ManipulatorGeometry::fromUrdf(tiltedUrdf(limit));
      ADD_FAILURE() << "accepted: " << limit;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("joint jz: attribute acceleration"), std::string::npos) << error.what();
    }
  }
}

TEST(ManipulatorGeometry, TheRigsTiltTurnsThePipetteAboutItsTip) {
  const double tilt = 0.4;
  const ManipulatorGeometry upright = ManipulatorGeometry::fromUrdf(rigUrdf());
  const ManipulatorGeometry tilted = ManipulatorGeometry::fromUrdf(rigUrdf(), tilt);
  EXPECT_EQ(tilted.tilt.joint, "pipette_tilt");
  EXPECT_DOUBLE_EQ(tilted.tilt.angle, tilt);
  EXPECT_TRUE(upright.tip_at_zero.linear().isIdentity(1e-12));
  EXPECT_LT((tilted.tip_at_zero.translation() - upright.tip_at_zero.translation()).norm(), 1e-15);
  EXPECT_TRUE(tilted.tip_at_zero.linear().col(2).isApprox(Eigen::Vector3d(std::sin(tilt), 0, std::cos(tilt)), 1e-12));
  const Eigen::Vector3d joints(1e-3, -2e-3, 3e-3);
  EXPECT_LT((tilted.tip(joints) - upright.tip(joints)).norm(), 1e-15);
}

/// By hand: the third axis of tiltedUrdf points along w = (s, 0, c), the tilt's axis is y, and the tip hangs 1 mm below
/// the joint: with the angle b it is at (0.1, 0, 0) - 1 mm (sin(30 deg + b), 0, cos(30 deg + b)).
TEST(ManipulatorGeometry, TiltAboutAnotherPlaceMovesTheTip) {
  const std::string revolute = std::regex_replace(
      tiltedUrdf(), std::regex("<joint name=\"tip\" type=\"fixed\">"),
      "<joint name=\"lean\" type=\"revolute\"><parent link=\"c\"/><child link=\"d\"/><axis xyz=\"0 2 0\"/>"
      "<limit lower=\"-0.1\" upper=\"0.5\" velocity=\"1\" effort=\"1\"/></joint><link name=\"d\"/>"
      "<joint name=\"tip\" type=\"fixed\">");
  const std::string xml = std::regex_replace(revolute, std::regex("<parent link=\"c\"/><child link=\"needle_tip\"/>"),
                                             "<parent link=\"d\"/><child link=\"needle_tip\"/>");
  const double b = 0.3, angle = M_PI / 6 + b;
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(xml, b);
  const Eigen::Vector3d tip = Eigen::Vector3d(0.1, 0, 0) - 1e-3 * Eigen::Vector3d(std::sin(angle), 0, std::cos(angle));
  EXPECT_LT((rig.tip({0, 0, 0}) - tip).norm(), 1e-12);
  EXPECT_TRUE(rig.directions.isApprox(ManipulatorGeometry::fromUrdf(xml).directions, 1e-12));
  for (const double outside : {-0.11, 0.51, std::nan("")}) {
    EXPECT_THROW(ManipulatorGeometry::fromUrdf(xml, outside), ConfigError) << outside;
  }
  EXPECT_THROW(ManipulatorGeometry::fromUrdf(tiltedUrdf(), 0.1), ConfigError);  // it has no such joint
}

TEST(ManipulatorGeometry, NamesTheAxisThatIsTooFast) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(tiltedUrdf());
  EXPECT_EQ(rig.tooFast({1e-3, -1e-3, 0}), "");
  const std::string reason = rig.tooFast({0, -1.5e-3, 0});
  EXPECT_NE(reason.find("jy velocity = -0.0015 m/s, allowed [-0.001, 0.001] m/s"), std::string::npos) << reason;
}

TEST(ManipulatorGeometry, WhoIsOutsideMayComeBackOnly) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(tiltedUrdf());
  EXPECT_EQ(rig.leavesTravel({1.1e-3, 0, 0}, {1.05e-3, 0, 0}), "");
  EXPECT_EQ(rig.leavesTravel({1.1e-3, 0, 0}, {1.1e-3, 5e-4, 0}), "");
  EXPECT_NE(rig.leavesTravel({1.1e-3, 0, 0}, {1.11e-3, 0, 0}), "");
  EXPECT_NE(rig.leavesTravel({1.1e-3, 0, 0}, {-1.01e-3, 0, 0}), "");
  EXPECT_NE(rig.leavesTravel({1.1e-3, 0, 0}, {1e-3, 1.01e-3, 0}).find("jy"), std::string::npos);
}

TEST(ManipulatorGeometry, RefusesWhatIsNoThreeAxisRig) {
  EXPECT_THROW(ManipulatorGeometry::fromUrdf("not XML"), ConfigError);
  EXPECT_THROW(ManipulatorGeometry::fromUrdf(
                   tiltedUrdf(R"(<limit lower="1e-3" upper="2e-3" velocity="1" acceleration="0.2" effort="1"/>)")),
               ConfigError);
  const std::string missing = std::regex_replace(tiltedUrdf(), std::regex("needle_tip"), "tool");
  EXPECT_THROW(ManipulatorGeometry::fromUrdf(missing), ConfigError);
  const std::string two_axes =
      std::regex_replace(tiltedUrdf(), std::regex("\"jy\" type=\"prismatic\""), "\"jy\" type=\"fixed\"");
  EXPECT_THROW(ManipulatorGeometry::fromUrdf(two_axes), ConfigError);
  const std::string flat = std::regex_replace(tiltedUrdf(), std::regex("axis xyz=\"0 1 0\""), "axis xyz=\"1 0 0\"");
  EXPECT_THROW(ManipulatorGeometry::fromUrdf(flat), ConfigError);
}

}  // namespace
}  // namespace microinjection
