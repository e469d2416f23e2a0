#include "vision/calibration/camera_model.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

CalibrationVector<double> identity() {
  CalibrationVector<double> p = CalibrationVector<double>::Zero();
  p[kPixelSize] = 0.1e-6;
  p[kAxisRatio] = 1;
  return p;
}

TEST(CameraModel, WorldXGoesRightAndWorldZUp) {
  const Eigen::Matrix<double, 2, 3> axes = imageAxes(identity(), false);
  EXPECT_TRUE(axes.col(0).isApprox(Eigen::Vector2d(1e7, 0)));
  EXPECT_TRUE(axes.col(1).isZero());
  EXPECT_TRUE(axes.col(2).isApprox(Eigen::Vector2d(0, -1e7)));
}

TEST(CameraModel, AMirrorTurnsXAround) {
  EXPECT_TRUE(imageAxes(identity(), true).col(0).isApprox(Eigen::Vector2d(-1e7, 0)));
  EXPECT_TRUE(imageAxes(identity(), true).col(2).isApprox(Eigen::Vector2d(0, -1e7)));
}

TEST(CameraModel, APositiveAngleTurnsThePictureCounterClockwise) {
  CalibrationVector<double> p = identity();
  p[kAngle] = 0.5 * 3.14159265358979323846;
  const Eigen::Matrix<double, 2, 3> axes = imageAxes(p, false);
  EXPECT_NEAR((axes.col(0) - Eigen::Vector2d(0, -1e7)).norm(), 0, 1e-6);
  EXPECT_NEAR((axes.col(2) - Eigen::Vector2d(-1e7, 0)).norm(), 0, 1e-6);
}

TEST(CameraModel, SkewIsTheAngleBetweenTheAxesBeyondARightOne) {
  CalibrationVector<double> p = identity();
  p[kSkew] = 0.1;
  const Eigen::Matrix<double, 2, 3> axes = imageAxes(p, false);
  const double cosine = axes.col(0).dot(axes.col(2)) / axes.col(0).norm() / axes.col(2).norm();
  EXPECT_NEAR(cosine, std::cos(0.5 * 3.14159265358979323846 + 0.1), 1e-12);
}

TEST(CameraModel, AxisRatioAndPixelSizeAreThoseOfTheAxes) {
  CalibrationVector<double> p = identity();
  p[kAxisRatio] = 1.21;
  const Eigen::Matrix<double, 2, 3> axes = imageAxes(p, false);
  EXPECT_NEAR(axes.col(2).norm() / axes.col(0).norm(), 1.21, 1e-12);
  EXPECT_NEAR(1 / std::sqrt(axes.col(0).norm() * axes.col(2).norm()), 0.1e-6, 1e-18);
}

TEST(CameraModel, ParametersComeBackFromTheAxes) {
  for (const bool mirrored : {false, true}) {
    for (double angle = -3.1; angle < 3.14; angle += 0.31) {
      CalibrationVector<double> p = identity(), found = CalibrationVector<double>::Zero();
      p[kAngle] = angle;
      p[kSkew] = -0.07;
      p[kAxisRatio] = 0.95;
      const Eigen::Matrix<double, 2, 3> axes = imageAxes(p, mirrored);
      EXPECT_EQ(setImageAxes(found, axes.col(0), axes.col(2)), mirrored);
      EXPECT_TRUE(found.isApprox(p, 1e-12)) << angle << '\n' << found.transpose();
    }
  }
}

}  // namespace
}  // namespace microinjection
