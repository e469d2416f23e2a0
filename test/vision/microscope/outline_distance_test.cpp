#include "vision/microscope/outline_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vision/microscope/microscope_scene.h"

namespace microinjection {
namespace {

/// Largest error in px over the pixels whose true distance to the circle is in [from, to).
double worstError(const OutlineDistance& result, const Eigen::Vector2d& centre, double radius, double from, double to) {
  double worst = 0;
  int count = 0;
  for (int y = 0; y < result.region.height; ++y) {
    for (int x = 0; x < result.region.width; ++x) {
      const Eigen::Vector2d pixel(x + result.region.x, y + result.region.y);
      const double truth = radius - (pixel - centre).norm();
      if (std::abs(truth) < from || std::abs(truth) >= to) continue;
      ++count;
      worst = std::max(worst, std::abs(truth - result.distance.at<float>(y, x)));
    }
  }
  EXPECT_GT(count, 100);
  return worst;
}

TEST(OutlineDistance, OfACircleIsExactNearIt) {
  const Eigen::Vector2d centre(150.3, 120.8);
  for (const double band : {12.0, 60.0}) {
    const OutlineDistance result = outlineDistance(circleOutline(centre, 90), band, cv::Size(320, 260));
    EXPECT_LT(worstError(result, centre, 90, 0, 9.9), 0.005) << band;
    EXPECT_LT(worstError(result, centre, 90, 9.9, band), 0.1) << band;
  }
}

TEST(OutlineDistance, TheSenseOfTheOutlineDoesNotMatter) {
  CellOutline outline = circleOutline({50, 50}, 30);
  const OutlineDistance there = outlineDistance(outline, 8, cv::Size(100, 100));
  std::reverse(outline.begin(), outline.end());
  const OutlineDistance back = outlineDistance(outline, 8, cv::Size(100, 100));
  EXPECT_LT(cv::norm(there.distance, back.distance, cv::NORM_INF), 1e-4);
}

TEST(OutlineDistance, OfANotchedSquareIsThatToItsNearestSide) {
  // A notch between x = 40 and 60 reaches down to y = 50.
  const CellOutline outline = {{20, 20}, {40, 20}, {40, 50}, {60, 50}, {60, 20}, {80, 20}, {80, 80}, {20, 80}};
  const OutlineDistance result = outlineDistance(outline, 9, cv::Size(100, 100));
  const auto at = [&](int x, int y) { return result.distance.at<float>(y - result.region.y, x - result.region.x); };
  EXPECT_NEAR(at(50, 30), -9, 1e-4);  // in the notch, farther than the band
  EXPECT_NEAR(at(43, 30), -3, 1e-4);
  EXPECT_NEAR(at(37, 30), 3, 1e-4);
  EXPECT_NEAR(at(50, 54), 4, 1e-4);
  EXPECT_NEAR(at(83, 84), -5, 1e-4);  // from a corner
  EXPECT_NEAR(at(30, 65), 9, 1e-4);
}

TEST(OutlineDistance, IsCutAtTheImage) {
  const OutlineDistance half = outlineDistance(circleOutline({0, 50}, 30), 8, cv::Size(100, 100));
  EXPECT_EQ(half.region.x, 0);
  EXPECT_LT(worstError(half, {0, 50}, 30, 0, 8), 0.005);
  EXPECT_TRUE(outlineDistance(circleOutline({-50, 50}, 30), 8, cv::Size(100, 100)).region.empty());
  EXPECT_TRUE(outlineDistance(circleOutline({1e9, 1e9}, 30), 8, cv::Size(100, 100)).region.empty());
}

}  // namespace
}  // namespace microinjection
