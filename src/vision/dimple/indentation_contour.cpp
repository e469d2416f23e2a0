#include "vision/dimple/indentation_contour.h"

#include <algorithm>
#include <cmath>

#include "vision/dimple/outline_trace.h"

namespace microinjection {
namespace {

constexpr double kMayTouch = 4;                              // px, of the tip from the border, that may still touch it
constexpr double kThinnestNeedle = 7, kThickestNeedle = 30;  // px, half of the needle's width near its tip
constexpr double kFirstWindow = 4, kLaterWindow = 3;         // px, to both sides of a flank
constexpr int kTraces = 2;                                   // along the fitted outline
constexpr double kTipDeviation = 0.4, kUncertainTip = 1;     // px, at least, along a needle before a cell
constexpr double kHiddenDeviation = 0.2;                     // of what the needle hides of the dent's shape
constexpr double kDepthsAgree = 1.5;                         // px, of both depths, and up to kDepthsAgreeDeviations
constexpr double kDepthsAgreeDeviations = 3;
constexpr double kSureDepthDeviation = 0.55;  // px
constexpr double kSureUsed = 0.8;             // of the border's points

/// The border with its dent: traced along the clearest path first, then along what was fitted.
DentedEllipse fitOutline(const Frame& frame, const CellBorder& border, const NeedleShadow& needle,
                         std::vector<BorderPoint>& points) {
  points = traceOutline(frame, border, needle, findOutline(frame, border, needle), 0, kFirstWindow);
  DentedEllipse dented = fitDentedEllipse(points, needle.axis, border.ellipse);
  for (int i = 0; i < kTraces && dented.valid; ++i) {
    points = traceOutline(frame, border, needle, outlineOf(dented, needle.axis), border.shift, kLaterWindow);
    dented = fitDentedEllipse(points, needle.axis, dented);
  }
  return dented;
}

/// A depth and its standard deviation, px.
struct Depth {
  double value, deviation;
};

/// From the undisturbed border to the tip.
Depth depthOfTip(const DentedEllipse& dented, const NeedleShadow& needle, double tip_deviation) {
  return {dented.top(needle.axis), std::hypot(dented.top_deviation, std::max(tip_deviation, kTipDeviation))};
}

/// Of the dent's shape alone. What the needle hides of it is not measured.
Depth depthOfDent(const DentedEllipse& dented, const NeedleShadow& needle) {
  const double hidden = dented.depth - dented.displacement(needle.axis, needle.half_width + kBesideNeedle);
  return {dented.depth, std::hypot(dented.depth_deviation, kHiddenDeviation * hidden)};
}

Depth mean(const Depth& a, const Depth& b) {
  const double wa = 1 / (a.deviation * a.deviation), wb = 1 / (b.deviation * b.deviation);
  return {(wa * a.value + wb * b.value) / (wa + wb), 1 / std::sqrt(wa + wb)};
}

Dimple indentationBy(const Frame& frame, const CellBorder& border, const NeedleShadow& needle, double tip_deviation) {
  Dimple result;
  result.finding = Finding::notFound("there is no outline of a cell");
  if (!border.finding.hasValues()) return result;
  result.finding = Finding::notFound("the tip is outside of the cell's outline: there is no dimple");
  if (border.ellipse.distance(needle.axis.tip) > kMayTouch) return result;
  result.at_cell = true;
  std::vector<BorderPoint> points;
  const DentedEllipse dented = fitOutline(frame, border, needle, points);
  result.finding = Finding::notFound("the outline under the needle is not clear");
  if (!dented.valid) return result;
  result.outline = dented.ellipse;
  result.centre_covariance = dented.centre_covariance;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].facing && dented.used[i]) result.contour.push_back(points[i].place);
  }
  const Depth of_tip = depthOfTip(dented, needle, tip_deviation), of_dent = depthOfDent(dented, needle);
  const double apart = std::abs(of_tip.value - of_dent.value);
  const bool touches =
      apart < std::max(kDepthsAgree, kDepthsAgreeDeviations * std::hypot(of_tip.deviation, of_dent.deviation));
  const Depth depth = touches ? mean(of_tip, of_dent) : of_dent;
  result.depth = std::max(0.0, depth.value);
  result.deviation = depth.deviation;
  result.deepest = needle.axis.tip + (dented.top(needle.axis) - result.depth) * needle.axis.along();
  const bool described = static_cast<double>(std::count(dented.used.begin(), dented.used.end(), true)) >=
                         kSureUsed * static_cast<double>(points.size());
  result.outline_found =
      described && border.finding.isFound() && std::sqrt(dented.centre_covariance.trace()) < kSureCentre;
  if (!touches)
    result.finding = Finding::uncertain("the outline under the needle is not at the tip: it may not touch");
  else if (!described)
    result.finding = Finding::uncertain("a part of the outline is not that of a cell with a dimple");
  else if (result.deviation > kSureDepthDeviation)
    result.finding = Finding::uncertain("the outline beside the needle is not clear");
  else
    result.finding = border.finding;
  return result;
}

}  // namespace

Dimple findIndentation(const Frame& frame, const CellBorder& border, const cv::Point2d& tip, double direction,
                       double width) {
  return indentationBy(frame, border, {{tip, direction}, 0.5 * width, 0}, 0);
}

Dimple findIndentation(const Frame& frame, const CellBorder& border, const PipetteDetection& needle) {
  Dimple result;
  result.finding = Finding::notFound("there is no needle that could indent the cell");
  if (!needle.finding.hasValues()) return result;
  const double half_width = std::clamp(needle.half_width, kThinnestNeedle, kThickestNeedle);
  const NeedleShadow shadow{{needle.end, needle.direction}, half_width, std::max(0.0, needle.taper)};
  const Eigen::Vector2d along(std::cos(needle.direction), std::sin(needle.direction));
  const double deviation = std::sqrt(along.dot(needle.covariance * along));
  result =
      indentationBy(frame, border, shadow, needle.finding.isFound() ? deviation : std::max(deviation, kUncertainTip));
  if (border.finding.hasValues()) result.displacement = findDisplacement(frame, border, needle.end, needle.direction);
  return result;
}

}  // namespace microinjection
