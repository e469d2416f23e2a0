#include "vision/segmentation/working_image.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include <cmath>
#include <limits>

namespace microinjection {
namespace {

/// A disc of another grey on a plane, CV_32F.
cv::Mat disc(const cv::Size& size, const cv::Point2d& centre, double radius, double inside, double outside) {
  cv::Mat image(size, CV_32F);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      image.at<float>(y, x) = static_cast<float>(std::hypot(x - centre.x, y - centre.y) < radius ? inside : outside);
  return image;
}

TEST(WorkingImage, FitsEveryImageAndMapsItsPixels) {
  for (const cv::Size& size : {cv::Size(1392, 1040), cv::Size(350, 200), cv::Size(100, 300), cv::Size(64, 64)}) {
    const WorkingImage working(disc(size, {size.width / 2.0, size.height / 2.0}, 20, 0.2, 0.6));
    EXPECT_TRUE(working.region.width == WorkingImage::kWidth || working.region.height == WorkingImage::kHeight);
    const cv::Point2d pixel(17.25, 31.5), back = working.toImage(working.fromImage(pixel));
    EXPECT_NEAR(back.x, pixel.x, 1e-9);
    EXPECT_NEAR(back.y, pixel.y, 1e-9);
    // The image's border is the region's.
    const cv::Point2d corner = working.fromImage({-0.5, -0.5});
    EXPECT_NEAR(corner.x, working.region.x - 0.5, 1e-9);
    EXPECT_NEAR(corner.y, working.region.y - 0.5, 1e-9);
  }
}

TEST(WorkingImage, PlacesWhatItShows) {
  const WorkingImage working(disc({1024, 768}, {300, 420}, 100, 0.2, 0.6));
  const cv::Moments moments = cv::moments(working.planes[0] < 100, true);
  const cv::Point2d place = working.toImage({moments.m10 / moments.m00, moments.m01 / moments.m00});
  EXPECT_NEAR(place.x, 300, 1);
  EXPECT_NEAR(place.y, 420, 1);
}

TEST(WorkingImage, DoesNotDependOnLightAndExposure) {
  const cv::Mat image = disc({400, 300}, {200, 150}, 60, 0.4, 0.6);
  const WorkingImage one(image), other(image * 0.1 + 0.02);
  for (int i = 0; i < WorkingImage::kPlanes; ++i) EXPECT_LE(cv::norm(one.planes[i], other.planes[i], cv::NORM_INF), 1);
}

TEST(WorkingImage, TakesAnImageOfOneGreyAndOneThatIsNotFinite) {
  const WorkingImage grey(cv::Mat(100, 100, CV_32F, 0.5F));
  EXPECT_EQ(cv::countNonZero(grey.planes[0] != 128), 0);
  cv::Mat holes = disc({256, 192}, {100, 100}, 30, 0.1, 0.7);
  holes.at<float>(50, 50) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_GT(cv::countNonZero(WorkingImage(holes).planes[0] != 128), 1000);
}

}  // namespace
}  // namespace microinjection
