#include "operation/teleoperation/device_axes_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "operation/teleoperation/frame_mapping.h"

namespace microinjection {
namespace {

constexpr double kDegree = M_PI / 180;

/// All 24 rotations that map axes to axes: row i is the device's axis along the view's axis i.
std::vector<Eigen::Matrix3d> rotations(double determinant = 1) {
  std::vector<Eigen::Matrix3d> found;
  int order[] = {0, 1, 2};
  do {
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
      for (int row = 0; row < 3; ++row) matrix(row, order[row]) = signs & (1 << row) ? -1 : 1;
      if (matrix.determinant() == determinant) found.push_back(matrix);
    }
  } while (std::next_permutation(order, order + 3));
  return found;
}

/// An operator who moves by `length` (m) along each axis of the view, in a device that is mounted
/// askew by `tilt`. Returns the last refusal.
std::string move(DeviceAxesFit& fit, const Eigen::Matrix3d& axes, const Eigen::Matrix3d& tilt, double length = 0.04) {
  std::string refusal;
  for (int i = 0; i < 3 && refusal.empty(); ++i)
    refusal = fit.add(length * tilt * axes.transpose() * Eigen::Vector3d::Unit(i));
  return refusal;
}

Eigen::Matrix3d tilted(double angle) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(0.3, -0.8, 0.5).normalized()).toRotationMatrix();
}

TEST(DeviceAxesFit, FindsEveryRotationThatTheBridgeTakes) {
  ASSERT_EQ(rotations().size(), 24u);
  for (const Eigen::Matrix3d& axes : rotations()) {
    DeviceAxesFit fit;
    ASSERT_EQ(move(fit, axes, tilted(20 * kDegree)), "");
    FrameMappingConfig config;
    config.device_axes = fit.axes();
    const FrameMapping frame(config);
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(frame.toWorld(Eigen::Vector3d::Unit(i)), Eigen::Vector3d(axes.col(i))) << fit.axes();
  }
}

TEST(DeviceAxesFit, NamesTheNextMotion) {
  DeviceAxesFit fit;
  EXPECT_EQ(fit.next(), "right");
  fit.add({0.02, 0, 0});
  EXPECT_EQ(fit.next(), "away");
  fit.add({0, 0, -0.02});
  EXPECT_EQ(fit.next(), "up");
  EXPECT_FALSE(fit.complete());
  fit.removeLast();
  EXPECT_EQ(fit.next(), "away");
  fit.add({0, 0, -0.02});
  EXPECT_EQ(fit.add({0, 0.02, 0}), "");
  EXPECT_TRUE(fit.complete());
  EXPECT_EQ(fit.next(), "");
  EXPECT_EQ(fit.axes(), "x -z y");
}

TEST(DeviceAxesFit, HasTheResidualsOfATurnAndOfAnObliqueMotion) {
  for (const double angle : {0.0, 1e-4, 5.0, 25.0}) {
    DeviceAxesFit turned;  // about the device's z: two motions are off by the angle, all stay square
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    ASSERT_EQ(move(turned, Eigen::Matrix3d::Identity(), turn), "");
    EXPECT_NEAR(turned.angleToAxis(), angle * kDegree, 1e-12);
    EXPECT_NEAR(turned.angleToSquare(), 0, 1e-12);

    DeviceAxesFit oblique;  // the second motion leans towards the first
    oblique.add({0.02, 0, 0});
    oblique.add({0.03 * std::sin(angle * kDegree), 0.03 * std::cos(angle * kDegree), 0});
    EXPECT_NEAR(oblique.angleToAxis(), angle * kDegree, 1e-12);
    EXPECT_NEAR(oblique.angleToSquare(), angle * kDegree, 1e-12);
  }
}

TEST(DeviceAxesFit, RefusesAShortMotion) {
  DeviceAxesFit fit;
  EXPECT_EQ(fit.add({9.9e-3, 0, 0}), "the hand moved 9.9 mm: move it 10 mm or more");
  EXPECT_NE(fit.add(Eigen::Vector3d::Zero()), "");
  EXPECT_EQ(fit.motions(), 0);
  EXPECT_EQ(fit.add({10.1e-3, 0, 0}), "");
}

TEST(DeviceAxesFit, RefusesAnObliqueMotion) {
  const auto at = [](double angle) {
    return Eigen::Vector3d(0.02 * std::cos(angle * kDegree), 0, -0.02 * std::sin(angle * kDegree));
  };
  DeviceAxesFit fit;
  EXPECT_EQ(fit.add(at(31)), "the motion is 31.0 degrees off the device's nearest axis: at most 30; move it straight");
  EXPECT_NE(fit.add(at(45)), "");
  EXPECT_NE(fit.add(at(59)), "");
  EXPECT_NE(fit.add({0.02, 0.02, 0.02}), "");
  EXPECT_EQ(fit.motions(), 0);
  EXPECT_EQ(fit.add(at(29)), "");
}

TEST(DeviceAxesFit, RefusesTwoMotionsAlongOneAxis) {
  DeviceAxesFit fit;
  fit.add({0, 0.02, 0});
  for (const double sign : {1.0, -1.0}) {
    EXPECT_EQ(fit.add({0, sign * 0.03, 0}), "the motion is along the same axis of the device as the motion right");
  }
  fit.add({0.02, 0, 0});
  EXPECT_EQ(fit.add({-0.02, 0, 0}), "the motion is along the same axis of the device as the motion away");
  EXPECT_EQ(fit.motions(), 2);
}

TEST(DeviceAxesFit, RefusesEveryMirroredSet) {
  const std::vector<Eigen::Matrix3d> mirrored = rotations(-1);
  ASSERT_EQ(mirrored.size(), 24u);
  for (const Eigen::Matrix3d& axes : mirrored) {
    DeviceAxesFit fit;
    EXPECT_NE(move(fit, axes, tilted(20 * kDegree)).find("mirrored"), std::string::npos);
    EXPECT_EQ(fit.motions(), 2);
  }
}

TEST(DeviceAxesFit, RefusesWhatIsNotFinite) {
  DeviceAxesFit fit;
  EXPECT_NE(fit.add({std::nan(""), 0.02, 0}), "");
  EXPECT_NE(fit.add({INFINITY, 0, 0}), "");
  EXPECT_EQ(fit.motions(), 0);
}

}  // namespace
}  // namespace microinjection
