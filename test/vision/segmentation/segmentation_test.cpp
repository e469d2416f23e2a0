#include "vision/segmentation/segmentation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

const std::initializer_list<PixelClass> kCell = {PixelClass::kZona, PixelClass::kOoplasm};

/// Of a frame of 1024 x 768: an ooplasm and a zona around it as discs with a soft border, and an ooplasm far away.
Segmentation drawn(const cv::Point2d& centre, double ooplasm, double zona) {
  const cv::Size frame(1024, 768);
  const WorkingImage working(cv::Mat(frame, CV_32F, 0.5F));
  std::array<cv::Mat, kPixelClasses> planes;
  for (cv::Mat& plane : planes) plane = cv::Mat(Segmentation::kHeight, Segmentation::kWidth, CV_32F, cv::Scalar(0));
  const auto inside = [](double distance, double radius) { return 1 / (1 + std::exp((distance - radius) / 3)); };
  for (int y = 0; y < Segmentation::kHeight; ++y) {
    for (int x = 0; x < Segmentation::kWidth; ++x) {
      // The frame is 8 times as fine.
      const cv::Point2d pixel(8 * x + 3.5, 8 * y + 3.5);
      const double distance = cv::norm(pixel - centre);
      const double in = inside(distance, ooplasm), whole = inside(distance, zona);
      const double second = inside(cv::norm(pixel - cv::Point2d(900, 100)), 40);
      planes[static_cast<std::size_t>(PixelClass::kOoplasm)].at<float>(y, x) = static_cast<float>(in + second);
      planes[static_cast<std::size_t>(PixelClass::kZona)].at<float>(y, x) = static_cast<float>(whole - in);
      planes[0].at<float>(y, x) = static_cast<float>(1 - whole - second);
    }
  }
  return {planes, working, frame};
}

TEST(Segmentation, MapsPixels) {
  const Segmentation segmentation = drawn({400, 300}, 150, 200);
  EXPECT_DOUBLE_EQ(segmentation.framePixels(), 8);
  EXPECT_NEAR(segmentation.toFrame({0, 0}).x, 3.5, 1e-9);
  EXPECT_NEAR(segmentation.fromFrame({3.5, 11.5}).y, 1, 1e-9);
}

TEST(Segmentation, MeasuresTheLargestRegion) {
  const Segmentation segmentation = drawn({401.5, 333.25}, 150, 200);
  const auto ooplasm = segmentation.largestRegion({PixelClass::kOoplasm});
  ASSERT_TRUE(ooplasm);
  EXPECT_NEAR(ooplasm->diameter, 300, 1);
  EXPECT_NEAR(ooplasm->centre.x, 401.5, 0.2);
  EXPECT_NEAR(ooplasm->centre.y, 333.25, 0.2);
  EXPECT_NEAR(ooplasm->semi_major, 150, 1);
  EXPECT_NEAR(ooplasm->semi_minor, 150, 1);
  EXPECT_FALSE(ooplasm->touches_border);
  EXPECT_GT(ooplasm->probability, 0.9);
  // A zona is a ring: its region has the hole filled, as has that of the whole cell.
  EXPECT_NEAR(segmentation.largestRegion({PixelClass::kZona})->diameter, 400, 2);
  EXPECT_NEAR(segmentation.largestRegion(kCell)->diameter, 400, 1);
}

TEST(Segmentation, ListsRegionsByTheirArea) {
  const auto regions = drawn({400, 300}, 150, 200).regions({PixelClass::kOoplasm});
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_NEAR(regions[1].centre.x, 900, 2);
  EXPECT_NEAR(regions[1].diameter, 80, 3);
  EXPECT_EQ(drawn({400, 300}, 150, 200).regions({PixelClass::kOoplasm}, 10000).size(), 1U);
}

TEST(Segmentation, TellsWhatTheFrameCuts) {
  const auto region = drawn({100, 300}, 150, 200).largestRegion({PixelClass::kOoplasm});
  ASSERT_TRUE(region);
  EXPECT_TRUE(region->touches_border);
}

TEST(Segmentation, HasNothingOfAClassThatIsNotThere) {
  EXPECT_FALSE(drawn({400, 300}, 150, 200).largestRegion({PixelClass::kBubble}));
  EXPECT_EQ(cv::countNonZero(drawn({400, 300}, 150, 200).mask({PixelClass::kBubble})), 0);
}

TEST(Segmentation, FindsTheEndOfWhatEntersThroughTheBorder) {
  const cv::Size frame(1024, 768);
  std::array<cv::Mat, kPixelClasses> planes;
  for (cv::Mat& plane : planes) plane = cv::Mat(Segmentation::kHeight, Segmentation::kWidth, CV_32F, cv::Scalar(0));
  // A cone from the right border to (40, 30), and a blunt tube from the left one to (20, 70), in output px.
  const std::vector<cv::Point> cone = {{40, 30}, {127, 38}, {127, 52}};
  cv::fillConvexPoly(planes[static_cast<std::size_t>(PixelClass::kInjectionPipette)], cone, 1);
  cv::rectangle(planes[static_cast<std::size_t>(PixelClass::kHoldingPipette)], cv::Rect(0, 60, 21, 21), 1, cv::FILLED);
  const Segmentation segmentation(planes, WorkingImage(cv::Mat(frame, CV_32F, 0.5F)), frame);
  const auto tip = segmentation.wayOf(*segmentation.largestRegion({PixelClass::kInjectionPipette}));
  const auto mouth = segmentation.wayOf(*segmentation.largestRegion({PixelClass::kHoldingPipette}));
  ASSERT_TRUE(tip && mouth);
  EXPECT_LT(cv::norm(tip->end - segmentation.toFrame({40, 30})), 10);
  EXPECT_LT(cv::norm(mouth->end - segmentation.toFrame({20, 70})), 6);
  EXPECT_FALSE(drawn({400, 300}, 150, 200).wayOf(*drawn({400, 300}, 150, 200).largestRegion(kCell)));
}

TEST(Segmentation, HasMasks) {
  const Segmentation segmentation = drawn({400, 300}, 150, 200);
  const double disc = M_PI * 150 * 150 + M_PI * 40 * 40;
  EXPECT_NEAR(cv::countNonZero(segmentation.mask({PixelClass::kOoplasm})) * 64.0, disc, 0.02 * disc);
}

}  // namespace
}  // namespace microinjection
