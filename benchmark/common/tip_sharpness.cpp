#include "benchmark/common/tip_sharpness.h"

#include <cmath>

#include "vision/pipette/pipette_strip.h"

namespace microinjection {
namespace {

constexpr int kHalfWindow = 14;  // px, of the window across the axis
constexpr int kBefore = 6;       // px of the window beyond the tip

}  // namespace

double tipSharpness(const Frame& frame, const cv::Point2d& tip, double direction, double length) {
  PipetteStrip::Shape shape;
  shape.direction = direction;
  shape.half = kHalfWindow;
  shape.rows = static_cast<int>(length) + kBefore;
  shape.origin = tip - kBefore * cv::Point2d(std::cos(direction), std::sin(direction));
  const PipetteStrip strip(frame, shape, 0.8, 0.8);
  double sum = 0, brightness = 0;
  int count = 0;
  for (int row = 1; row + 1 < strip.rows(); ++row) {
    if (!strip.inside(row)) continue;
    const float *above = strip.grey().ptr<float>(row - 1), *here = strip.grey().ptr<float>(row);
    const float* below = strip.grey().ptr<float>(row + 1);
    for (int i = 1; i + 1 < strip.grey().cols; ++i, ++count) {
      const double across = here[i - 1] - 2 * here[i] + here[i + 1], along = above[i] - 2 * here[i] + below[i];
      sum += across * across + along * along;
      brightness += here[i];
    }
  }
  return brightness > 0 ? sum * count / (brightness * brightness) : 0;
}

}  // namespace microinjection
