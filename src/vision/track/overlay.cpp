#include "vision/track/overlay.h"

#include <cmath>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace microinjection {
namespace {

constexpr double kDegrees = 180 / M_PI;
constexpr int kFractionalBits = 4;  // fractional bits of the drawn places
const cv::Scalar kOoplasm(80, 220, 80), kZona(60, 160, 255), kInner(255, 180, 60), kNeedle(80, 80, 255),
    kHolding(255, 255, 80), kText(255, 255, 255);

cv::Point fixed(const cv::Point2d& point) {
  return {cv::saturate_cast<int>(point.x * (1 << kFractionalBits)),
          cv::saturate_cast<int>(point.y * (1 << kFractionalBits))};
}

void line(cv::Mat& image, const cv::Point2d& a, const cv::Point2d& b, const cv::Scalar& colour) {
  cv::line(image, fixed(a), fixed(b), colour, 1, cv::LINE_AA, kFractionalBits);
}

void text(cv::Mat& image, const std::string& words, const cv::Point2d& place, const cv::Scalar& colour) {
  const double size = image.cols < 500 ? 0.35 : 0.45;
  const cv::Point at(static_cast<int>(place.x), static_cast<int>(place.y));
  cv::putText(image, words, at, cv::FONT_HERSHEY_SIMPLEX, size, cv::Scalar(0, 0, 0), 3, cv::LINE_AA);
  cv::putText(image, words, at, cv::FONT_HERSHEY_SIMPLEX, size, colour, 1, cv::LINE_AA);
}

std::string format(const char* pattern, double a, double b = 0) {
  char words[160];
  std::snprintf(words, sizeof words, pattern, a, b);
  return words;
}

void border(cv::Mat& image, const CellBorder& seen, const cv::Scalar& colour) {
  if (!seen.finding.hasValues()) return;
  constexpr int kParts = 180;
  for (int i = 0; i < kParts; ++i) {
    if (!seen.finding.isFound() && i % 4 >= 2) continue;
    line(image, seen.ellipse.at(2 * M_PI * i / kParts), seen.ellipse.at(2 * M_PI * (i + 1) / kParts), colour);
  }
}

/// A line of the legend in the corner.
class Legend {
 public:
  explicit Legend(cv::Mat& image) : image_(image) {}
  void add(const std::string& words, const cv::Scalar& colour) {
    row_ += image_.cols < 500 ? 13 : 17;
    text(image_, words, {6, row_}, colour);
  }

 private:
  cv::Mat& image_;
  double row_ = 0;
};

void drawCell(cv::Mat& image, const CellDetection& cell, Legend& legend) {
  legend.add(std::string("cell: ") + nameOf(cell.finding.verdict) +
                 (cell.finding.reason.empty() ? "" : ": " + cell.finding.reason),
             kText);
  if (!cell.finding.hasValues()) return;
  if (cell.finding.isFound() && !cell.size.isFound())
    legend.add("its diameter is uncertain: " + cell.size.reason, kText);
  border(image, cell.ooplasm, kOoplasm);
  border(image, cell.zona_inner, kInner);
  border(image, cell.zona_outer, kZona);
  if (cell.polar_body.finding.hasValues()) {
    CellBorder body;
    body.finding = cell.polar_body.finding;
    body.ellipse = cell.polar_body.outline;
    border(image, body, kInner);
    legend.add(format("polar body at %.1f +- %.1f degrees", cell.polar_body.angle * kDegrees,
                      cell.polar_body.deviation * kDegrees),
               kInner);
  }
  line(image, cell.centre - cv::Point2d(6, 0), cell.centre + cv::Point2d(6, 0), kText);
  line(image, cell.centre - cv::Point2d(0, 6), cell.centre + cv::Point2d(0, 6), kText);
  legend.add(format("centre %.1f, %.1f px", cell.centre.x, cell.centre.y), kText);
  const auto diameter = [&](const CellBorder& seen, const char* name, const cv::Scalar& colour) {
    if (!seen.finding.hasValues()) return;
    legend.add(std::string(name) + format(" %.1f +- %.1f px", seen.ellipse.meanDiameter(), diameterDeviation(seen)),
               colour);
  };
  diameter(cell.zona_outer, "zona, outside", kZona);
  diameter(cell.zona_inner, "zona, inside", kInner);
  diameter(cell.ooplasm, "ooplasm", kOoplasm);
}

void drawPipette(cv::Mat& image, const PipetteDetection& pipette, const char* name, const cv::Scalar& colour,
                 Legend& legend) {
  legend.add(std::string(name) + ": " + nameOf(pipette.finding.verdict) +
                 (pipette.finding.reason.empty() ? "" : ": " + pipette.finding.reason),
             colour);
  if (!pipette.finding.hasValues()) return;
  const cv::Point2d u(std::cos(pipette.direction), std::sin(pipette.direction)), v(-u.y, u.x);
  const double half = std::max(8.0, pipette.half_width);
  line(image, pipette.end, pipette.end + 120 * u, colour);
  line(image, pipette.end - half * v, pipette.end + half * v, colour);
  legend.add(format("  at %.1f, %.1f px", pipette.end.x, pipette.end.y) +
                 format(", +- %.2f px", std::sqrt(pipette.covariance.trace())),
             colour);
}

/// A line across the bore, dashed where it is uncertain.
void drawBore(cv::Mat& image, const BoreBorder* border, const PipetteDetection* pipette, const char* name,
              const cv::Scalar& colour, Legend& legend) {
  if (border == nullptr || pipette == nullptr || !border->finding.hasValues()) return;
  const cv::Point2d across(-std::sin(pipette->direction), std::cos(pipette->direction));
  const double half = 0.5 * pipette->half_width;
  for (const double side : {-1.0, 1.0}) {
    const double first = border->finding.isFound() ? 0 : 0.4 * half;
    line(image, border->place + side * first * across, border->place + side * half * across, colour);
  }
  legend.add(std::string(name) + format(" %.1f +- %.1f px", border->length, border->deviation) +
                 (border->finding.isFound() ? "" : ", uncertain: " + border->finding.reason),
             colour);
}

}  // namespace

cv::Mat drawOverlay(const Frame& frame, const OverlayContent& content) {
  if (!frame.refusal().empty()) {
    cv::Mat black(cv::Size(640, 120), CV_8UC3, cv::Scalar(0, 0, 0));
    text(black, frame.refusal(), {8, 60}, kText);
    return black;
  }
  double low = 0, high = 1;
  cv::minMaxLoc(frame.grey(), &low, &high);
  cv::Mat grey, image;
  const double gain = 255 / std::max(high - low, 1e-6);
  frame.grey().convertTo(grey, CV_8U, gain, -low * gain);
  cv::cvtColor(grey, image, cv::COLOR_GRAY2BGR);
  Legend legend(image);
  if (content.cell != nullptr) drawCell(image, *content.cell, legend);
  if (content.holding != nullptr) drawPipette(image, *content.holding, "holding pipette", kHolding, legend);
  if (content.injection != nullptr) drawPipette(image, *content.injection, "injection pipette", kNeedle, legend);
  drawBore(image, content.tongue, content.holding, "tongue", kHolding, legend);
  drawBore(image, content.column, content.injection, "in the needle", kNeedle, legend);
  if (content.indentation != nullptr && content.indentation->finding.hasValues()) {
    for (std::size_t i = 1; i < content.indentation->contour.size(); ++i) {
      const cv::Point2d &a = content.indentation->contour[i - 1], &b = content.indentation->contour[i];
      if (cv::norm(a - b) < 20) line(image, a, b, kText);
    }
    legend.add(format("dimple %.1f +- %.1f px", content.indentation->depth, content.indentation->deviation), kText);
  }
  return image;
}

}  // namespace microinjection
