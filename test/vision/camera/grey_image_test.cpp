#include "vision/camera/grey_image.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace microinjection {
namespace {

/// Levels from `low` to `high` along x.
cv::Mat ramp(int type, double low, double high) {
  cv::Mat image(100, 201, CV_64F);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) image.at<double>(y, x) = low + (high - low) * x / 200;
  image.convertTo(image, type);
  return image;
}

TEST(GreyImage, AHotAndADeadPixelDoNotMoveTheRange) {
  cv::Mat image = ramp(CV_16U, 1000, 3000);
  image.at<unsigned short>(10, 10) = 65535;
  image.at<unsigned short>(20, 20) = 0;
  const GreyRange range = greyRange(image, 0.001);
  EXPECT_NEAR(range.low, 1000, 10);
  EXPECT_NEAR(range.high, 3000, 10);
}

TEST(GreyImage, EightAndSixteenBitOfTheSameSceneAreTheSame) {
  const cv::Mat shallow = toGrey8(ramp(CV_8U, 20, 220), 0), deep = toGrey8(ramp(CV_16U, 5140, 56540), 0);
  EXPECT_LE(cv::norm(shallow, deep, cv::NORM_INF), 1);
  EXPECT_NEAR(shallow.at<unsigned char>(50, 100), 127.5, 1);
}

TEST(GreyImage, EightBitIsCutAtTheEndsOfItsRange) {
  const cv::Mat image = toGrey8(ramp(CV_16U, 0, 40000), 0.1);
  EXPECT_EQ(image.type(), CV_8U);
  EXPECT_EQ(image.at<unsigned char>(0, 5), 0);
  EXPECT_EQ(image.at<unsigned char>(0, 195), 255);
  EXPECT_NEAR(image.at<unsigned char>(0, 100), 127.5, 2);
}

TEST(GreyImage, ColourIsWeighted) {
  const cv::Mat green = toGrey(cv::Mat(2, 2, CV_8UC3, cv::Scalar(0, 100, 0)));
  EXPECT_EQ(green.at<unsigned char>(0, 0), 59);
  const cv::Mat red = toGrey(cv::Mat(2, 2, CV_16UC4, cv::Scalar(0, 0, 10000, 7)));
  EXPECT_NEAR(red.at<unsigned short>(0, 0), 2990, 2);
}

TEST(GreyImage, OneLevelBecomesTheMiddle) {
  EXPECT_EQ(toGrey8(cv::Mat(8, 8, CV_8U, cv::Scalar(255))).at<unsigned char>(3, 3), 128);
  EXPECT_NEAR(toGrey8(cv::Mat(8, 8, CV_16U, cv::Scalar(0))).at<unsigned char>(3, 3), 128, 1);
}

TEST(GreyImage, RefusesWhatIsNoFrame) {
  EXPECT_THROW(toGrey(cv::Mat(2, 2, CV_32F, cv::Scalar(0))), cv::Exception);
  EXPECT_THROW(toGrey(cv::Mat(2, 2, CV_8UC2, cv::Scalar(0))), cv::Exception);
}

}  // namespace
}  // namespace microinjection
