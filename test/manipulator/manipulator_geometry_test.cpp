#include "manipulator/manipulator_geometry.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "base/errors.h"

namespace microinjection {
namespace {

std::string rigUrdf() {
  std::ifstream file(std::string(MICROINJECTION_SOURCE_DIR) + "/urdf/rig.urdf");
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

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
