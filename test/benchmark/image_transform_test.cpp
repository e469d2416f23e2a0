#include "benchmark/common/image_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr double kDotRadius = 6;  // px

/// A grey image with a dark dot, and a mark in its middle.
MarkedImage markedDot(int format = CV_8UC1, double full = 255) {
  MarkedImage image;
  const cv::Point2d place(70.25, 41.5);
  cv::Mat fraction(100, 140, CV_32F);
  for (int y = 0; y < fraction.rows; ++y) {
    for (int x = 0; x < fraction.cols; ++x) {
      const double distance = std::hypot(x - place.x, y - place.y) / kDotRadius;
      fraction.at<float>(y, x) = static_cast<float>(0.7 - 0.4 * std::exp(-distance * distance));
    }
  }
  fraction.convertTo(image.image, CV_MAT_DEPTH(format), full);
  if (CV_MAT_CN(format) == 3) cv::cvtColor(image.image, image.image, cv::COLOR_GRAY2BGR);
  image.marks.push_back({"tip", place, 2 * kDotRadius, 1});
  return image;
}

/// Middle of what deviates from the background about the mark.
cv::Point2d middleOfDot(const MarkedImage& marked) {
  cv::Mat grey = marked.image, difference;
  if (grey.channels() == 3) cv::cvtColor(grey, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_64F);
  const cv::Point2d place = marked.marks.front().place;
  const int reach = static_cast<int>(2 * kDotRadius * marked.scale);
  const cv::Point middle(cvRound(place.x), cvRound(place.y));
  const cv::Rect window(middle - cv::Point(reach, reach), cv::Size(2 * reach + 1, 2 * reach + 1));
  const cv::Mat part = grey(window);
  difference = cv::abs(part - part.at<double>(0, 0));
  difference.setTo(0, difference < 0.5 * *std::max_element(difference.begin<double>(), difference.end<double>()));
  const cv::Moments moments = cv::moments(difference);
  return {window.x + moments.m10 / moments.m00, window.y + moments.m01 / moments.m00};
}

TEST(ImageTransforms, KeepTheMarkOnWhatItMarks) {
  for (const MarkedImage& original : {markedDot(), markedDot(CV_8UC3), markedDot(CV_16UC1, 4095)}) {
    for (const ImageTransform& transform : imageTransforms()) {
      const MarkedImage changed = transform.apply(original);
      const cv::Point2d off = middleOfDot(changed) - changed.marks.front().place;
      // The gradient of light and the noise move what is seen of a dot of 6 px.
      EXPECT_LT(std::hypot(off.x, off.y), 0.35 * changed.scale) << transform.name;
      EXPECT_DOUBLE_EQ(changed.marks.front().diameter, 2 * kDotRadius * changed.scale) << transform.name;
      EXPECT_DOUBLE_EQ(changed.marks.front().tolerance, changed.scale) << transform.name;
    }
  }
}

TEST(ImageTransforms, LeaveTheOriginalAsItIs) {
  const MarkedImage original = markedDot();
  const cv::Mat before = original.image.clone();
  for (const ImageTransform& transform : imageTransforms()) {
    transform.apply(original);
    EXPECT_EQ(cv::norm(before, original.image, cv::NORM_INF), 0) << transform.name;
  }
}

TEST(ImageTransforms, TurnTheShaftWithTheImage) {
  MarkedImage original = markedDot();
  original.needle = 0.3;
  original.holding = original.needle + M_PI;
  for (const ImageTransform& transform : imageTransforms()) {
    double expected = original.needle;
    if (transform.name == "mirrored") expected = M_PI - original.needle;
    if (transform.name == "turned_17") expected = original.needle + 17 * M_PI / 180;
    const MarkedImage changed = transform.apply(original);
    EXPECT_NEAR(std::remainder(changed.needle - expected, 2 * M_PI), 0, 1e-12) << transform.name;
    EXPECT_NEAR(std::abs(std::remainder(changed.holding - changed.needle, 2 * M_PI)), M_PI, 1e-12) << transform.name;
  }
}

TEST(ImageTransforms, KnowWhatHasLeftTheFrame) {
  MarkedImage original = markedDot();
  original.marks.front().place = {1, 1};
  for (const ImageTransform& transform : imageTransforms())
    EXPECT_EQ(transform.apply(original).marks.front().in_frame, transform.name != "turned_17") << transform.name;
}

}  // namespace
}  // namespace microinjection
