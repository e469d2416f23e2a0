#include "vision/frame/ellipse.h"

#include <gtest/gtest.h>

#include <random>

namespace microinjection {
namespace {

const Ellipse kTurned{{210.3, 140.7}, {90, 60}, 0.6};

/// px, by points all along the border.
double distanceByPoints(const Ellipse& ellipse, const cv::Point2d& point) {
  constexpr int kPoints = 100000;
  double least = 1e9;
  for (int i = 0; i < kPoints; ++i) least = std::min(least, cv::norm(ellipse.at(2 * M_PI * i / kPoints) - point));
  return least;
}

/// Along the border, with noise.
std::vector<cv::Point2d> borderPoints(const Ellipse& ellipse, double noise, unsigned seed) {
  constexpr int kPoints = 180;
  std::mt19937 random(seed);
  std::normal_distribution<double> error(0, noise);
  std::vector<cv::Point2d> points;
  for (int i = 0; i < kPoints; ++i)
    points.push_back(ellipse.at(2 * M_PI * i / kPoints) + cv::Point2d(error(random), error(random)));
  return points;
}

Ellipse circleAbout(const Ellipse& ellipse) {
  const double radius = ellipse.meanDiameter() / 2;
  return {ellipse.centre + cv::Point2d(3, -2), {radius, radius}, 0};
}

TEST(Ellipse, ItsBorderLiesWhereItsDirectionsReach) {
  EXPECT_NEAR(kTurned.meanDiameter(), 2 * std::sqrt(90 * 60), 1e-12);
  for (double t = 0; t < 6; t += 0.37) {
    const cv::Point2d border = kTurned.at(t), arm = border - kTurned.centre;
    EXPECT_NEAR(kTurned.distance(border), 0, 1e-9);
    EXPECT_NEAR(kTurned.radius(std::atan2(arm.y, arm.x)), cv::norm(arm), 1e-9);
    const cv::Point2d inside = kTurned.centre + cv::Point2d(20, 15), way = border - inside;
    EXPECT_NEAR(kTurned.reach(inside, std::atan2(way.y, way.x)), cv::norm(way), 1e-9);
  }
  EXPECT_EQ(kTurned.reach(kTurned.centre + cv::Point2d(200, 0), 0), 0);
}

TEST(Ellipse, ALineLeavesItAheadOrBehindOrMissesIt) {
  const cv::Point2d left = kTurned.centre - cv::Point2d(300, 0);
  const std::optional<double> through = kTurned.exit(left, 0), behind = kTurned.exit(left, M_PI);
  ASSERT_TRUE(through && behind);
  EXPECT_NEAR(kTurned.distance(left + cv::Point2d(*through, 0)), 0, 1e-9);
  EXPECT_GT(*through, 300);
  EXPECT_LT(*behind, 0);
  EXPECT_FALSE(kTurned.exit(left, M_PI / 2));
}

TEST(Ellipse, DistanceIsOfFirstOrder) {
  for (const double away : {0.5, 2.0, 4.0}) {
    for (double t = 0.1; t < 6; t += 0.7) {
      const cv::Point2d border = kTurned.at(t), out = (border - kTurned.centre) / cv::norm(border - kTurned.centre);
      // Its error is of second order in the distance, over a radius of curvature of 40 px at least.
      EXPECT_NEAR(kTurned.distance(border + away * out), distanceByPoints(kTurned, border + away * out),
                  away * away / 40 + 1e-3);
      EXPECT_LT(kTurned.distance(border - away * out), 0);
    }
  }
}

TEST(FitEllipse, FindsAnEllipseBesideOutliers) {
  std::vector<cv::Point2d> points = borderPoints(kTurned, 0.2, 1);
  for (std::size_t i = 3; i < points.size(); i += 9) points[i] = kTurned.centre + 1.15 * (points[i] - kTurned.centre);
  const EllipseFit fit = fitEllipse(points, circleAbout(kTurned), 3);
  ASSERT_TRUE(fit.valid);
  EXPECT_NEAR(cv::norm(fit.ellipse.centre - kTurned.centre), 0, 0.1);
  EXPECT_NEAR(fit.ellipse.semi_axes[0], 90, 0.15);
  EXPECT_NEAR(fit.ellipse.semi_axes[1], 60, 0.15);
  EXPECT_NEAR(std::remainder(fit.ellipse.angle - kTurned.angle, M_PI), 0, 0.01);
  EXPECT_NEAR(fit.residual, 0.2, 0.05);
  EXPECT_FALSE(fit.inlier[30]);
  EXPECT_TRUE(fit.inlier[100]);
}

TEST(FitEllipse, ItsCovarianceIsThatOfRepeatedFits) {
  constexpr int kFits = 300;
  Eigen::Vector3d square = Eigen::Vector3d::Zero(), told = Eigen::Vector3d::Zero();
  for (unsigned seed = 1; seed <= kFits; ++seed) {
    const EllipseFit fit = fitEllipse(borderPoints(kTurned, 0.3, seed), circleAbout(kTurned), 3);
    ASSERT_TRUE(fit.valid);
    const Eigen::Vector3d error(fit.ellipse.centre.x - kTurned.centre.x, fit.ellipse.centre.y - kTurned.centre.y,
                                fit.ellipse.meanDiameter() - kTurned.meanDiameter());
    square += error.cwiseAbs2() / kFits;
    told += fit.covariance.diagonal() / kFits;
  }
  // A variance of 300 fits is known to 8 %.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(told[k] / square[k], 1, 0.3) << k;
}

TEST(FitEllipse, ACircleHasEqualAxes) {
  const EllipseFit fit = fitEllipse(borderPoints({{80, 90}, {50, 50}, 0}, 0.2, 3), {{82, 88}, {47, 47}, 0}, 3, true);
  ASSERT_TRUE(fit.valid);
  EXPECT_NEAR(fit.ellipse.semi_axes[0], fit.ellipse.semi_axes[1], 1e-9);
  EXPECT_NEAR(fit.ellipse.meanDiameter(), 100, 0.1);
}

TEST(FitEllipse, RefusesTooFewPoints) {
  EXPECT_FALSE(fitEllipse({{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, {{0, 0}, {1, 1}, 0}, 3).valid);
}

}  // namespace
}  // namespace microinjection
