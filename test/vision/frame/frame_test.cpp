#include "vision/frame/frame.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

namespace microinjection {
namespace {

/// CV_32F: a slope along x with normal noise.
cv::Mat slopeWithNoise(double noise) {
  cv::Mat image(240, 320, CV_32F), grain(240, 320, CV_32F);
  for (int x = 0; x < image.cols; ++x) image.col(x) = 0.3 + 0.4 * x / image.cols;
  cv::theRNG().state = 7;
  cv::randn(grain, 0, noise);
  return image + grain;
}

cv::Mat as(const cv::Mat& image, int type, double full) {
  cv::Mat result;
  image.convertTo(result, type, full);
  return result;
}

TEST(Frame, MeansTheSameInEachFormat) {
  const cv::Mat image = slopeWithNoise(0.01);
  cv::Mat colours;
  cv::merge(std::vector<cv::Mat>(3, as(image, CV_8U, 255)), colours);
  const Frame exact(image);
  for (const cv::Mat& format : {as(image, CV_8U, 255), as(image, CV_16U, 65535), colours}) {
    const Frame frame(format);
    EXPECT_TRUE(frame.refusal().empty());
    EXPECT_LT(cv::norm(frame.grey(), exact.grey(), cv::NORM_INF), 0.003);
    EXPECT_NEAR(frame.noise(), exact.noise(), 0.05 * exact.noise());
    EXPECT_NEAR(frame.background(), exact.background(), 0.003);
  }
}

TEST(Frame, KnowsItsNoiseButNotItsSlope) {
  for (const double noise : {0.003, 0.01, 0.03}) EXPECT_NEAR(Frame(slopeWithNoise(noise)).noise(), noise, 0.1 * noise);
  EXPECT_DOUBLE_EQ(Frame(as(slopeWithNoise(0), CV_8U, 255)).noise(), 0.3 / 255);  // its rounding
}

TEST(Frame, SaysWhyItShowsNothing) {
  const auto refusal = [](const cv::Mat& image) { return Frame(image).refusal(); };
  cv::Mat broken = slopeWithNoise(0.01);
  broken.at<float>(7, 9) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(refusal({}), "the frame is empty");
  EXPECT_EQ(refusal(cv::Mat(100, 20, CV_8U, cv::Scalar(9))), "the frame is truncated: a side has fewer than 32 pixels");
  EXPECT_EQ(refusal(cv::Mat(100, 100, CV_64F, cv::Scalar(0.5))),
            "the frame's format is not known: 8 or 16 bit or float with 1, 3 or 4 channels");
  EXPECT_EQ(refusal(cv::Mat(100, 100, CV_8U, cv::Scalar(0))), "the frame is black");
  EXPECT_EQ(refusal(cv::Mat(100, 100, CV_8U, cv::Scalar(90))), "the frame is all one grey");
  EXPECT_EQ(refusal(cv::Mat(100, 100, CV_8U, cv::Scalar(255))),
            "the frame is over-exposed: almost every pixel is saturated");
  EXPECT_EQ(refusal(broken), "the frame has values that are not finite");
}

TEST(Frame, PlacesOfALevelAreThoseOfTheMeansOfItsSquares) {
  cv::Mat places(121, 161, CV_32FC2);  // an odd row and column, which are left out
  for (int y = 0; y < places.rows; ++y) {
    for (int x = 0; x < places.cols; ++x)
      places.at<cv::Vec2f>(y, x) = {static_cast<float>(x) / 161, static_cast<float>(y) / 161};
  }
  std::vector<cv::Mat> parts;
  cv::split(places, parts);
  const Frame by_x(parts[0]), by_y(parts[1]);
  for (const int level : {1, 2}) {
    EXPECT_EQ(by_x.level(level).cols, 160 >> level);
    for (const cv::Point& at : {cv::Point(0, 0), cv::Point(17, 9)}) {
      const cv::Point2d place = Frame::fromLevel(at, level);
      EXPECT_NEAR(by_x.level(level).at<float>(at) * 161, place.x, 1e-4);
      EXPECT_NEAR(by_y.level(level).at<float>(at) * 161, place.y, 1e-4);
      EXPECT_NEAR(cv::norm(Frame::toLevel(place, level) - cv::Point2d(at)), 0, 1e-12);
    }
  }
  EXPECT_EQ(by_x.resized(1).width(), 80);
  EXPECT_EQ(by_x.resized(-1).width(), 322);
}

TEST(Frame, ContainsPlacesWithinItsMargin) {
  const Frame frame(slopeWithNoise(0.01));
  EXPECT_TRUE(frame.contains({0, 239}) && frame.contains({10, 10}, 10));
  EXPECT_FALSE(frame.contains({-0.1, 10}) || frame.contains({10, 9.9}, 10) || frame.contains({319.1, 10}));
}

}  // namespace
}  // namespace microinjection
