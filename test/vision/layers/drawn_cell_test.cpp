// Cells that were drawn, not rendered: without noise, without blur, with edges of whole pixels.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <random>
#include <string>

#include "vision/layers/cell_size.h"

namespace microinjection {
namespace {

struct Drawing {
  double radius = 152;       // px
  cv::Point2d centre{0, 0};  // px, from the middle of the picture
  int samples = 1;           // of a pixel, along each side: 1 is not antialiased
  double blur = 0;           // px
  double noise = 0;          // grey levels
};

cv::Mat draw(const Drawing& drawing, std::mt19937& random, const std::function<double(double)>& grey) {
  const int side = 2 * static_cast<int>(drawing.radius) + 100, n = drawing.samples;
  const double middle = side / 2;
  cv::Mat image(side, side, CV_64F), result;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      double sum = 0;
      for (int i = 0; i < n * n; ++i) {
        const double dx = x + (i % n + 0.5) / n - 0.5 - middle - drawing.centre.x;
        const double dy = y + (i / n + 0.5) / n - 0.5 - middle - drawing.centre.y;
        sum += grey(std::hypot(dx, dy));
      }
      image.at<double>(y, x) = sum / (n * n);
    }
  }
  if (drawing.blur > 0) cv::GaussianBlur(image, image, {0, 0}, drawing.blur);
  std::normal_distribution<double> normal(0, drawing.noise);
  for (auto value = image.begin<double>(); value != image.end<double>() && drawing.noise > 0; ++value)
    *value += normal(random);
  image.convertTo(result, CV_8U);
  return result;
}

/// The diameter with its interval; none: it is not sure.
std::optional<MeasuredLength> diameterOf(const cv::Mat& image) {
  CellSizeReadings readings(1);
  readings.add(CellDetector(CellDetectorConfig()).detect(Frame(image)));
  std::string reason;
  const std::optional<CellSizeInImages> size = readings.measure(1, reason);
  return size ? std::optional(size->diameter) : std::nullopt;
}

TEST(DrawnCell, TheIntervalsHoldTheDiameterOfADisc) {
  std::mt19937 random(5);
  const auto within = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
  int sure = 0, covered = 0;
  for (int i = 0; i < 45; ++i) {
    Drawing drawing{within(70, 190), {within(-1, 1), within(-1, 1)}, i % 3 == 0 ? 1 : 6};
    drawing.blur = i % 3 == 2 ? within(0.5, 2) : 0;
    drawing.noise = i % 2 == 0 ? 0 : within(0, 4);
    const double step = within(30, 110);
    const auto diameter =
        diameterOf(draw(drawing, random, [&](double r) { return r < drawing.radius ? 170 - step : 170.0; }));
    if (!diameter) continue;
    ++sure;
    const double error = diameter->value - 2 * drawing.radius;
    if (std::abs(error) <= diameter->interval) ++covered;
    EXPECT_NEAR(error, 0, 0.3) << "radius " << drawing.radius << ", blur " << drawing.blur << ", step " << step;
    EXPECT_LT(diameter->interval, 0.3);
  }
  EXPECT_GT(sure, 35);
  EXPECT_GE(covered, sure - 2);
}

/// With less noise the slope beside a border is that of rounding only: the whole flank was a full border.
TEST(DrawnCell, TheZonasDiameterDoesNotDependOnTheNoise) {
  for (const double noise : {0.5, 1.0, 2.0, 6.0}) {
    std::mt19937 random(2);
    const Drawing drawing{152, {0, 0}, 1, 0, noise};
    const auto diameter = diameterOf(draw(drawing, random, [](double r) {
      const double line = 38 * std::exp(-0.5 * std::pow((r - 152) / 1.5, 2));
      const double rim = 90 * std::exp(-0.5 * std::pow((r - 128) / 2.5, 2));
      return 158 - line - rim - (r < 128 ? 12 : 0);
    }));
    ASSERT_TRUE(diameter) << noise;
    EXPECT_NEAR(diameter->value, 304, diameter->interval) << noise;
    EXPECT_GT(diameter->interval, 0.09) << noise;
    EXPECT_LT(diameter->interval, 0.3) << noise;
  }
}

}  // namespace
}  // namespace microinjection
