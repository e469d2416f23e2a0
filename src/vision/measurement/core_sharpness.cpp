#include "vision/measurement/core_sharpness.h"

#include <algorithm>
#include <cmath>

#include "vision/pipette/pipette_strip.h"

namespace microinjection {
namespace {

constexpr double kFirst = 4, kRows = 40;  // px behind the tip: the end itself has fringes, too
constexpr int kBendStep = 2;              // px, of the differences
constexpr double kBlur = 0.8;             // px

}  // namespace

double coreSharpness(const Frame& frame, const TipInImage& window) {
  const int half = std::max(1, window.core);
  PipetteStrip::Shape shape;
  shape.direction = window.direction;
  shape.half = half + kBendStep + 1;
  shape.rows = static_cast<int>(kRows);
  shape.origin = window.tip + kFirst * cv::Point2d(std::cos(window.direction), std::sin(window.direction));
  const PipetteStrip strip(frame, shape, kBlur, kBlur);
  double sum = 0;
  int count = 0;
  for (int row = 1; row + 1 < strip.rows(); ++row) {
    if (!strip.inside(row)) continue;
    const float* grey = strip.grey().ptr<float>(row) + strip.grey().cols / 2;
    for (int i = -half; i <= half; ++i, ++count) {
      const double bend = grey[i - kBendStep] - 2 * grey[i] + grey[i + kBendStep];
      sum += bend * bend;
    }
  }
  return count > 0 ? sum / (count * frame.noise() * frame.noise()) : 0;
}

}  // namespace microinjection
