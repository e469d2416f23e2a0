#include "vision/detection/tip_focus.h"

#include <algorithm>
#include <cmath>

#include "vision/detection/pipette_strip.h"

namespace microinjection {
namespace {

constexpr int kHalf = 14;           // px, of the window across the axis
constexpr int kBefore = 6;          // px of the window beyond the tip
constexpr double kClearPeak = 1.3;  // of the median of the stack, at least

}  // namespace

double tipSharpness(const Frame& frame, const cv::Point2d& tip, double direction, double length) {
  PipetteStrip::Shape shape;
  shape.direction = direction;
  shape.half = kHalf;
  shape.rows = static_cast<int>(length) + kBefore;
  shape.origin = tip - kBefore * cv::Point2d(std::cos(direction), std::sin(direction));
  const PipetteStrip strip(frame, shape, 0.8, 0.8);
  double sum = 0;
  int count = 0;
  for (int row = 1; row + 1 < strip.rows(); ++row) {
    if (!strip.inside(row)) continue;
    const float *above = strip.grey().ptr<float>(row - 1), *here = strip.grey().ptr<float>(row);
    const float* below = strip.grey().ptr<float>(row + 1);
    for (int i = 1; i + 1 < strip.grey().cols; ++i, ++count) {
      const double across = here[i - 1] - 2 * here[i] + here[i + 1], along = above[i] - 2 * here[i] + below[i];
      sum += across * across + along * along;
    }
  }
  return count > 0 ? sum / (count * frame.noise() * frame.noise()) : 0;
}

BestFocus bestFocus(const std::vector<double>& sharpness) {
  BestFocus best;
  const auto count = static_cast<int>(sharpness.size());
  if (count < 3 || *std::min_element(sharpness.begin(), sharpness.end()) <= 0) {
    best.finding = Finding::notFound("the stack has fewer than three planes that show the tip");
    return best;
  }
  const auto peak = static_cast<int>(std::max_element(sharpness.begin(), sharpness.end()) - sharpness.begin());
  std::vector<double> sorted = sharpness;
  std::nth_element(sorted.begin(), sorted.begin() + count / 2, sorted.end());
  if (sharpness[peak] < kClearPeak * sorted[count / 2]) {
    best.finding = Finding::notFound("no plane is sharper than the others");
    return best;
  }
  best.plane = peak;
  if (peak == 0 || peak + 1 == count) {
    best.deviation = 1;
    best.finding = Finding::uncertain("the sharpest plane is at the end of the stack: the best one may be beyond it");
    return best;
  }
  const double a = std::log(sharpness[peak - 1]), b = std::log(sharpness[peak]), c = std::log(sharpness[peak + 1]);
  const double bend = a - 2 * b + c;
  if (bend < 0) best.plane += std::clamp(0.5 * (a - c) / bend, -0.5, 0.5);
  // A flat peak is not certain to a plane.
  best.deviation = std::min(1.0, 0.05 / std::sqrt(std::max(-bend, 1e-4)));
  best.finding = Finding::found();
  return best;
}

}  // namespace microinjection
