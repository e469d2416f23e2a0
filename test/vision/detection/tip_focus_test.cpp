#include "vision/detection/tip_focus.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

std::vector<double> bell(double centre, int planes) {
  std::vector<double> values;
  for (int i = 0; i < planes; ++i) values.push_back(3 + 100 * std::exp(-0.1 * (i - centre) * (i - centre)));
  return values;
}

TEST(BestFocus, LiesBetweenThePlanes) {
  const BestFocus best = bestFocus(bell(7.3, 17));
  ASSERT_TRUE(best.finding.isFound()) << best.finding.reason;
  EXPECT_NEAR(best.plane, 7.3, 0.02);
}

TEST(BestFocus, AtTheEndItIsUncertain) {
  for (const double centre : {-1.0, 0.0, 16.0, 18.0}) {
    EXPECT_EQ(bestFocus(bell(centre, 17)).finding.verdict, Verdict::kUncertain) << centre;
  }
}

TEST(BestFocus, ASharplessStackHasNone) {
  EXPECT_FALSE(bestFocus(std::vector<double>(17, 5)).finding.hasValues());
  EXPECT_FALSE(bestFocus({}).finding.hasValues());
  EXPECT_FALSE(bestFocus({0, 0, 0, 0}).finding.hasValues());
}

TEST(TipSharpness, SeesTheTipOnly) {
  // The dust is at the other end of the frame and sharp; the tip is a line that blur widens.
  std::vector<double> sharpness;
  for (int plane = 0; plane < 9; ++plane) {
    const double blur = 1 + 0.5 * std::abs(plane - 4);
    cv::Mat image(300, 400, CV_8U, cv::Scalar(120));
    for (int y = 0; y < 150; ++y) {
      for (int x = 0; x < 400; ++x) {
        const double d = (x - 200) / blur, line = 60 / blur * std::exp(-0.5 * d * d);
        image.at<unsigned char>(y, x) = static_cast<unsigned char>(120 - line + ((x * 7 + y * 13) % 3));
      }
    }
    for (int y = 240; y < 240 + 10 * (plane > 6); ++y) image.at<unsigned char>(y, 40) = 0;
    sharpness.push_back(tipSharpness(Frame(image), {200, 149}, -M_PI / 2));
  }
  const BestFocus best = bestFocus(sharpness);
  ASSERT_TRUE(best.finding.isFound()) << best.finding.reason;
  EXPECT_NEAR(best.plane, 4, 0.1);
}

}  // namespace
}  // namespace microinjection
