// `origin` of a device's file, by the example of doc/guide/your_rig.md: which number belongs there, and where the
// needle would be taken to be with the number that is easily mistaken for it.

#include <gtest/gtest.h>

#include "../manipulator/rig_file.h"
#include "hardware/devices/joint_axes.h"
#include "hardware/manipulator/manipulator_geometry.h"

namespace microinjection {
namespace {

constexpr double kStart = 60e-6;           // m, the tip's height in world with the joints at 0, of urdf/rig.urdf
const Eigen::Vector3d kTip(0, 0, 200e-6);  // m, measured from the cell's centre
const Eigen::Vector3d kReading(12.5e-3, 12.5e-3, 11.86e-3);  // m, of the axes, with the tip there
const Eigen::Vector3d kDirections(1, 1, -1);                 // the third axis counts downwards

JointAxes axes(double origin_z) { return {kDirections, Eigen::Vector3d(-12.5e-3, -12.5e-3, origin_z)}; }

TEST(Origin, IsWhereTheJointsAreWhenTheAxesReadZero) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(rigUrdf());
  ASSERT_LT((rig.tip(Eigen::Vector3d::Zero()) - Eigen::Vector3d(0, 0, kStart)).norm(), 1e-12);
  const Eigen::Vector3d origin = kTip - Eigen::Vector3d(0, 0, kStart) - kDirections.cwiseProduct(kReading);
  EXPECT_LT((origin - Eigen::Vector3d(-12.5e-3, -12.5e-3, 12.0e-3)).norm(), 1e-12);
  const JointAxes right = axes(12.0e-3);
  EXPECT_LT((rig.tip(right.toJoints(kReading)) - kTip).norm(), 1e-12);
  EXPECT_LT((right.toDevice(rig.joints(kTip)) - kReading).norm(), 1e-12);
  // 10 um lower, which this axis counts upwards.
  EXPECT_NEAR(right.toDevice(rig.joints(kTip - Eigen::Vector3d(0, 0, 10e-6))).z(), 11.87e-3, 1e-12);
}

TEST(Origin, CountedFromTheCellsCentreSendsTheNeedleTooLow) {
  const ManipulatorGeometry rig = ManipulatorGeometry::fromUrdf(rigUrdf());
  const Eigen::Vector3d mistaken = kTip - kDirections.cwiseProduct(kReading);
  const JointAxes wrong = axes(mistaken.z());
  EXPECT_NEAR(rig.tip(wrong.toJoints(kReading)).z(), kTip.z() + kStart, 1e-12);  // where the session takes it to be
  const Eigen::Vector3d command = wrong.toDevice(rig.joints(Eigen::Vector3d(0, 0, 28e-6)));  // to the pole
  EXPECT_NEAR(rig.tip(axes(12.0e-3).toJoints(command)).z(), 28e-6 - kStart, 1e-12);          // where it truly goes
}

}  // namespace
}  // namespace microinjection
