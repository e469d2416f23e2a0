#include "vision/border/border_search.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "vision/border/cell_border.h"

namespace microinjection {
namespace {

const Ellipse kBase{{300, 280}, {150, 140}, 0.4};
constexpr double kNoise = 12;  // of 255 grey levels: as large as the ring is dark

/// Noise, with a ring that has `ratio` times the size of kBase.
cv::Mat image(double ratio, double darkness) {
  cv::Mat grey(560, 600, CV_32F, cv::Scalar(140));
  cv::Mat noise(grey.size(), CV_32F);
  cv::RNG(4).fill(noise, cv::RNG::NORMAL, 0, kNoise);
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      const Ellipse ring = scaled(kBase, ratio);
      const double off = ring.distance({static_cast<double>(x), static_cast<double>(y)}) / 1.6;
      grey.at<float>(y, x) -= static_cast<float>(darkness * std::exp(-0.5 * off * off));
    }
  }
  cv::Mat levels;
  cv::Mat(grey + noise).convertTo(levels, CV_8U);
  return levels;
}

TEST(FaintRing, IsFoundUnderNoiseThatHidesItInEachDirection) {
  const auto found = findFaintRing(Frame(image(1.2, 12)), kBase, 1.03, 1.5);
  ASSERT_TRUE(found);
  EXPECT_NEAR(*found, 1.2, 1.5 / 145);
}

TEST(FaintRing, IsNotSeenInNoiseAlone) { EXPECT_FALSE(findFaintRing(Frame(image(1.2, 0)), kBase, 1.03, 1.5)); }

TEST(FaintRing, ABarAcrossIsNone) {
  cv::Mat bar = image(1.2, 0);
  cv::rectangle(bar, cv::Rect(440, 230, 160, 90), cv::Scalar(40), cv::FILLED);
  EXPECT_FALSE(findFaintRing(Frame(bar), kBase, 1.03, 1.5));
}

TEST(FaintRing, NeedsRoomBesideItself) { EXPECT_FALSE(findFaintRing(Frame(image(1.2, 12)), kBase, 1.12, 1.27)); }

}  // namespace
}  // namespace microinjection
