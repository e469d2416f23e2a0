#include "benchmark/common/tip_sharpness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "vision/calibration/tip_focus.h"

namespace microinjection {
namespace {

TEST(TipSharpness, SeesTheTipOnly) {
  // The dust is at the other end of the frame and sharp; the tip is a line that blur widens.
  std::vector<FocusSample> stack;
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
    stack.push_back({1e-6 * plane, tipSharpness(Frame(image), {200, 149}, -M_PI / 2)});
  }
  const FocusReport best = findFocus(stack, {});
  ASSERT_EQ(best.verdict, FocusVerdict::kFocus) << best.text;
  EXPECT_NEAR(best.height, 4e-6, 0.1e-6);
}

}  // namespace
}  // namespace microinjection
