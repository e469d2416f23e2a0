#include "vision/frame/polar_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

namespace microinjection {
namespace {

const Ellipse kDisc{{150, 130}, {70, 50}, 0.4};

/// Dark within kDisc, with a border 3 px wide.
cv::Mat disc() {
  cv::Mat image(260, 300, CV_32F);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x)
      image.at<float>(y, x) = static_cast<float>(0.6 + 0.2 * std::tanh(kDisc.distance(cv::Point2d(x, y)) / 1.5));
  }
  return image;
}

TEST(PolarMap, AnEllipsesBorderIsAStraightColumn) {
  const Frame frame(disc());
  const PolarMap map(frame, kDisc, {-20, 20, 81, 90}, 1);
  const int middle = static_cast<int>(map.column(0, kDisc.radius(map.direction(0))));
  EXPECT_EQ(middle, 40);
  for (int ray = 0; ray < map.rays(); ++ray) {
    cv::Point steepest;
    cv::minMaxLoc(map.slope().row(ray), nullptr, nullptr, nullptr, &steepest);
    EXPECT_NEAR(steepest.x, middle, 1) << ray;
    EXPECT_NEAR(kDisc.distance(map.point(ray, middle)), 0, 1e-6);
    EXPECT_NEAR(map.grey().at<float>(ray, middle), 0.6, 0.03);
  }
}

TEST(PolarMap, ARayOutsideOfTheImageIsNotValid) {
  const Frame frame(disc());
  const PolarMap map(frame, cv::Point2d(10, 130), {0, 40, 41, 4}, 1);  // rays to the right, down, left and up
  EXPECT_EQ(cv::countNonZero(map.valid().row(0)), 41);
  EXPECT_LE(cv::countNonZero(map.valid().row(2)), 11);
  EXPECT_EQ(map.slope().at<float>(2, 30), 0);
}

/// The best closed path by trying each beginning.
double bestByBeginnings(const cv::Mat& value, int max_change) {
  double best = -1e9;
  for (int begin = 0; begin < value.cols; ++begin) {
    std::vector<double> sum(value.cols, -1e9);
    sum[begin] = value.at<float>(0, begin);
    for (int ray = 1; ray <= value.rows; ++ray) {
      std::vector<double> next(value.cols, -1e9);
      for (int to = 0; to < value.cols; ++to) {
        for (int from = std::max(0, to - max_change); from <= std::min(value.cols - 1, to + max_change); ++from)
          next[to] = std::max(next[to], sum[from] - 0.05 * std::abs(to - from));
        if (ray < value.rows) next[to] += value.at<float>(ray, to);
      }
      sum = next;
    }
    best = std::max(best, sum[begin]);
  }
  return best;
}

TEST(ClosedPath, IsTheBestThatEndsWhereItBegan) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 20; ++trial) {
    cv::Mat value(40, 15, CV_32F);
    const double phase = std::uniform_real_distribution<double>(0, 2 * M_PI)(random);
    for (int ray = 0; ray < value.rows; ++ray) {
      const double line = 7 + 4 * std::sin(2 * M_PI * ray / value.rows + phase);
      for (int column = 0; column < value.cols; ++column)
        value.at<float>(ray, column) = static_cast<float>(std::exp(-std::pow(column - line, 2) / 2) +
                                                          std::normal_distribution<double>(0, 0.05)(random));
    }
    const ClosedPath path = closedPath(value, 2);
    double sum = 0;
    for (int ray = 0; ray < value.rows; ++ray) {
      const int next = path.column[(ray + 1) % value.rows];
      EXPECT_LE(std::abs(path.column[ray] - next), 2);
      sum += value.at<float>(ray, path.column[ray]) - 0.05 * std::abs(path.column[ray] - next);
    }
    EXPECT_NEAR(sum, bestByBeginnings(value, 2), 1e-4);
  }
}

TEST(BorderStrength, HasTheSignOfThePolarity) {
  const Frame frame(disc());
  const PolarMap map(frame, kDisc, {-20, 20, 81, 90}, 1);
  const double scale = slopeScale(map, 35, 46);
  const auto at = [&](Polarity polarity) { return borderStrength(map, polarity, scale).at<float>(5, 40); };
  EXPECT_EQ(at(Polarity::kRising), 1);
  EXPECT_FLOAT_EQ(at(Polarity::kFalling), -0.3F);
  EXPECT_EQ(at(Polarity::kEither), 1);
}

}  // namespace
}  // namespace microinjection
