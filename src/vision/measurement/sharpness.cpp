#include "vision/measurement/sharpness.h"

#include <algorithm>
#include <cmath>

#include "vision/pipette/pipette_strip.h"

namespace microinjection {
namespace {

constexpr double kFirst = 4, kRows = 40;  // px behind the tip: the end itself has fringes, too
constexpr int kBendStep = 2;              // px, of the differences
constexpr double kBlur = 0.8;             // px

constexpr int kCurvatureStep = 2;  // px, of the differences
constexpr double kMargin = 8;      // px inside of the border, which has a rim
constexpr double kLeast = 0.25;    // of the border's radius, that is left inside of the margin

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

double cellSharpness(const Frame& frame, const CellDetection& cell) {
  if (!cell.finding.hasValues() || !cell.ooplasm.finding.hasValues()) return 0;
  const Ellipse& border = cell.ooplasm.ellipse;
  const double margin = std::min(kMargin, (1 - kLeast) * border.semi_axes[1]);
  const cv::Mat& grey = frame.grey();
  const auto within = [](double value, int size) {
    return std::clamp(static_cast<int>(value), kCurvatureStep, size - kCurvatureStep);
  };
  const double reach = border.semi_axes[0];
  double sum = 0;
  long count = 0;
  for (int y = within(border.centre.y - reach, grey.rows); y < within(border.centre.y + reach, grey.rows); ++y) {
    const float *above = grey.ptr<float>(y - kCurvatureStep), *here = grey.ptr<float>(y),
                *below = grey.ptr<float>(y + kCurvatureStep);
    for (int x = within(border.centre.x - reach, grey.cols); x < within(border.centre.x + reach, grey.cols); ++x) {
      if (border.distance(cv::Point2d(x, y)) > -margin) continue;
      const double across = here[x - kCurvatureStep] - 2 * here[x] + here[x + kCurvatureStep],
                   along = above[x] - 2 * here[x] + below[x];
      sum += across * across + along * along;
      ++count;
    }
  }
  return count > 0 ? sum / (static_cast<double>(count) * frame.noise() * frame.noise()) : 0;
}

}  // namespace microinjection
