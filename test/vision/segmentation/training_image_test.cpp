#include "vision/segmentation_training/training_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include <opencv2/core.hpp>

#include "vision/segmentation/pixel_class.h"

namespace microinjection {
namespace {

bool same(const cv::Mat& a, const cv::Mat& b) { return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0; }

TEST(TrainingImages, AreTheSameForASeed) {
  TrainingImages one, other;
  one.make(5);  // what was made before does not matter
  for (const std::uint64_t seed : {1, 2, 77, 1003}) {
    const TrainingImage a = one.make(seed), b = other.make(seed);
    EXPECT_TRUE(same(a.picture, b.picture)) << seed;
    EXPECT_TRUE(same(a.label, b.label)) << seed;
  }
  EXPECT_FALSE(same(one.make(1).picture, one.make(2).picture));
}

TEST(TrainingImages, HaveEveryClassAndALabelForEachPixel) {
  TrainingImages images;
  std::array<int, kPixelClasses> seen{};
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const TrainingImage image = images.make(seed);
    ASSERT_EQ(image.picture.type(), CV_8U);
    ASSERT_EQ(image.picture.size(), image.label.size()) << seed;
    double largest = 0;
    cv::minMaxLoc(image.label, nullptr, &largest);
    ASSERT_LT(largest, static_cast<double>(kPixelClasses)) << seed;
    for (std::size_t i = 0; i < kPixelClasses; ++i)
      if (cv::countNonZero(image.label == static_cast<int>(i)) > 0) ++seen[i];
  }
  for (std::size_t i = 0; i < kPixelClasses; ++i) EXPECT_GE(seen[i], 5) << kPixelClassNames[i];
  EXPECT_GE(seen[static_cast<std::size_t>(PixelClass::kOoplasm)], 80);
}

TEST(TrainingImages, AreLabelledWhereTheWorkingImageShowsThem) {
  cv::Mat grey(300, 300, CV_32F, 0.2F), label(300, 300, CV_8U, cv::Scalar(0));
  const cv::Rect square(60, 120, 90, 60);
  grey(square).setTo(0.8F);
  label(square).setTo(4);
  const WorkingImage working(grey);
  const cv::Mat result = workingLabel(label, working);
  // Square: there is no image to the left and to the right of it.
  EXPECT_EQ(result.at<unsigned char>(50, 2), kNoLabel);
  EXPECT_EQ(result.at<unsigned char>(50, WorkingImage::kWidth / 2 - 3), kNoLabel);
  cv::Mat shown;
  cv::resize(working.planes[0], shown, result.size(), 0, 0, cv::INTER_AREA);
  const cv::Mat differs = (shown > 140) != (result == 4);
  EXPECT_LT(cv::countNonZero(differs), 60);  // along the border only
  EXPECT_GT(cv::countNonZero(result == 4), 400);
}

}  // namespace
}  // namespace microinjection
