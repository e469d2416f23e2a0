#include "vision/detection/pipette_detector.h"

#include <algorithm>
#include <cmath>

#include "vision/detection/axis_fit.h"
#include "vision/detection/pipette_end.h"

namespace microinjection {
namespace {

constexpr int kAxes = 5, kHoldingAxes = 8;
constexpr double kWider = 1.38;        // ratio of two outlines' widths that tells them apart
constexpr double kLeastClearness = 3;  // of the shared edges at the end
constexpr int kAxisRows = 160;         // px behind the end, whose symmetry gives the axis
constexpr double kAcross = 1.5;        // px, blur of the derivative across the axis
constexpr double kWallEnded = 0.35, kEdgesEnded = 0.15, kSharedEnded = 0.25;  // see coarseEnd()
constexpr double kEmpty = 8;                 // clearness of a tip before an empty background
constexpr double kAxisMargin = 24;           // px beside an outline, that shows the symmetry
constexpr double kWidestPoint = 14;          // px from the axis, that a tip is looked for in
constexpr double kTube = 0.1;                // widening of a tube whose profile stays the same, at most
constexpr double kAgree = 6;                 // px, between two ways to see a tip's end
constexpr double kUnclear = 3;               // px, standard deviation of an end that needs a second witness
constexpr int kFirstShift = 24, kShift = 8;  // px, that an axis may be off
constexpr double kMargin = 6;                // px beside an outline

double outlineAt(const PipetteAxis& axis, const cv::Point2d& point) {
  const cv::Point2d d = point - axis.point;
  const double along = d.x * std::cos(axis.direction) + d.y * std::sin(axis.direction);
  return std::max(0.0, axis.half_width + axis.taper * along);
}

/// Where the axis, followed from its point towards the shaft, leaves the frame.
cv::Point2d entry(const Frame& frame, const PipetteAxis& axis) {
  const cv::Point2d u(std::cos(axis.direction), std::sin(axis.direction));
  cv::Point2d point = axis.point;
  while (frame.contains(point, 1)) point += u;
  while (!frame.contains(point, 1) && cv::norm(point - axis.point) < 4000) point -= u;
  return point;
}

std::vector<double> outlines(const PipetteStrip& strip, const PipetteAxis& axis, double factor, double margin) {
  std::vector<double> half;
  for (int row = 0; row < strip.rows(); ++row) {
    half.push_back((factor * outlineAt(axis, strip.point(row, 0)) + margin) / strip.shape().step);
  }
  return half;
}

/// A cut tube ends at half of its profile. A point, or a tube that widens quickly, has no profile
/// that stays the same; it ends where its edges do.
PipetteEnd tipIn(const PipetteStrip& strip, int row, double reach, double half_width) {
  const int half = static_cast<int>(std::min(0.6 * half_width + kMargin, kWidestPoint));
  const PipetteEnd point = pointNear(strip, row, reach, half);
  if (!point.valid || point.clearness < kEmpty) {
    const PipetteEnd tube = tubeNear(strip, row, reach, half);
    const PipetteEnd fine = tube.valid ? tipNear(strip, tube.row, half) : tube;
    return fine.valid ? fine : tube;
  }
  const PipetteEnd cut = tipNear(strip, point.row, half);
  const bool tube = widening(strip, point.row, 2 * half) < kTube;
  return cut.valid && tube && std::abs(cut.row - point.row) < kAgree ? cut : point;
}

}  // namespace

PipetteDetectorConfig PipetteDetectorConfig::read(ConfigReader& reader) {
  PipetteDetectorConfig config;
  reader.choice("kind", config.kind, {"injection", "holding"});
  reader.number("direction", config.direction, Range::closed(-2 * M_PI, 2 * M_PI));
  reader.number("tolerance", config.tolerance, Range::closed(0.02, M_PI / 2));
  reader.number("widest", config.widest, Range::closed(4, 1e4));
  reader.vector("region", config.region, Range::closed(0, 1e5));
  return config;
}

PipetteDetector::PipetteDetector(const PipetteDetectorConfig& config) : config_(config) {}

PipetteDetection PipetteDetector::detect(const Frame& frame) const {
  PipetteDetection best;
  if (!frame.refusal().empty()) {
    best.finding = Finding::notFound(frame.refusal());
    return best;
  }
  AxisSearch search;
  search.direction = config_.direction;
  search.tolerance = config_.tolerance;
  search.widest = config_.widest;
  if (config_.region[2] > 0) {
    search.region = cv::Rect(static_cast<int>(config_.region[0]), static_cast<int>(config_.region[1]),
                             static_cast<int>(config_.region[2]), static_cast<int>(config_.region[3]));
  }
  best.finding = Finding::notFound("no pipette: no two straight edges from the side that it comes from");
  const bool holding = config_.kind == "holding";
  for (const PipetteAxis& axis : findPipetteAxes(frame, search, holding ? kHoldingAxes : kAxes)) {
    if (holding && best.finding.isFound() && outlineAt(axis, best.end) < kWider * best.half_width) continue;
    const PipetteDetection found = measure(frame, axis);
    if (!found.finding.hasValues()) {
      if (!best.finding.hasValues()) best.finding = found.finding;
      continue;
    }
    // A thick wall is symmetric to an axis of its own. The widest outline is that of the whole.
    const bool wider = holding && found.half_width > kWider * best.half_width;
    if (!best.finding.hasValues() || wider || (found.finding.isFound() && !best.finding.isFound())) best = found;
    if (best.finding.isFound() && !holding) break;
  }
  return best;
}

PipetteDetection PipetteDetector::track(const Frame& frame, const PipetteDetection& previous, double reach) const {
  PipetteDetection found;
  found.finding = Finding::notFound("there is no earlier pipette to follow");
  if (!frame.refusal().empty()) found.finding = Finding::notFound(frame.refusal());
  if (!frame.refusal().empty() || !previous.finding.hasValues()) return found;
  PipetteAxis axis;
  axis.point = previous.end + 0.3 * kAxisRows * cv::Point2d(std::cos(previous.direction), std::sin(previous.direction));
  axis.direction = previous.direction;
  axis.half_width = previous.half_width;
  axis.taper = previous.taper;
  return refine(frame, axis, previous.end, reach + 10);
}

PipetteDetection PipetteDetector::measure(const Frame& frame, const PipetteAxis& axis) const {
  // At half the resolution, with room for an axis that is a little off.
  const cv::Point2d border = entry(frame, axis);
  const double length = std::hypot(frame.width(), frame.height());
  PipetteStrip::Shape shape;
  shape.step = 2;
  shape.direction = axis.direction;
  shape.rows = static_cast<int>(length / shape.step);
  shape.origin = border - length * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
  shape.half = static_cast<int>(std::min(0.5 * config_.widest, 1.2 * outlineAt(axis, border) + 16) / shape.step);
  const PipetteStrip strip(frame, shape, 1.0, 2.5);
  PipetteEnd end;
  if (config_.kind == "holding") {
    end = coarseEnd(strip, wallEdges(strip, outlines(strip, axis, 1, 0)), kWallEnded);
  } else {
    // Before an empty background all edges end; before a cell those that are symmetric to the axis.
    const std::vector<double> half = outlines(strip, axis, 1.2, kMargin);
    end = coarseEnd(strip, allEdges(strip, half), kEdgesEnded);
    if (!end.valid || end.clearness < kLeastClearness) end = coarseEnd(strip, sharedEdges(strip, half), kSharedEnded);
  }
  PipetteDetection none;
  none.finding = Finding::notFound("no pipette: an axis without an end in the image");
  if (!end.valid || end.clearness < kLeastClearness) return none;
  return refine(frame, axis, strip.point(end.row, 0), 60);
}

PipetteDetection PipetteDetector::refine(const Frame& frame, PipetteAxis axis, const cv::Point2d& end,
                                         double reach) const {
  PipetteDetection found;
  found.finding = Finding::notFound("no pipette: its end is not clear");
  const bool tip = config_.kind == "injection";
  cv::Point2d place = end;
  AxisFit fit;
  PipetteEnd last;
  double half_width = 0, slant = 0;
  for (int round = 0; round < 3; ++round) {
    const double back = reach + 24;
    half_width = std::max(
        4.0,
        outlineAt(axis, place + 0.3 * kAxisRows * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction))));
    PipetteStrip::Shape shape;
    shape.direction = axis.direction;
    shape.origin = place - back * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
    shape.rows = static_cast<int>(back) + kAxisRows + 40;
    const int most = round == 0 ? kFirstShift : kShift;
    shape.half = static_cast<int>(std::min(0.5 * config_.widest, 1.25 * half_width + kAxisMargin)) + most + 2;
    const PipetteStrip strip(frame, shape, kAcross, 1.0);
    const int row = static_cast<int>(back);
    fit = fitAxis(strip, row + 4, kAxisRows, 1.25 * half_width + kAxisMargin, most);
    if (!fit.valid) return found;
    // The strip of the axis as it is now.
    axis.point = strip.point(row + 4, fit.offset);
    axis.direction += std::atan(fit.slant);
    PipetteStrip::Shape straight = shape;
    straight.direction = axis.direction;
    straight.origin = axis.point - (back + 4) * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
    const PipetteStrip aligned(frame, straight, kAcross, tip ? 1.0 : 1.2);
    if (tip) {
      last = tipIn(aligned, row, round == 0 ? reach : 30, half_width);
    } else {
      last = mouthNear(aligned, row, half_width, round == 0 ? 24 : 8, slant);
    }
    if (!last.valid) return found;
    axis.half_width = half_width;
    place = aligned.point(last.row, 0);
  }
  found.end = place;
  found.direction = axis.direction;
  found.direction_deviation = fit.slant_deviation;
  found.half_width = half_width;
  found.taper = axis.taper;
  found.clearness = last.clearness;
  const double c = std::cos(axis.direction), s = std::sin(axis.direction);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  const Eigen::Vector2d variance(last.deviation * last.deviation, fit.offset_deviation * fit.offset_deviation);
  found.covariance = turn * variance.asDiagonal() * turn.transpose();
  found.finding = last.deviation > kUnclear ? Finding::uncertain("the pipette's end is not clear") : Finding::found();
  if (!frame.contains(found.end, 2)) found.finding = Finding::notFound("no pipette: its end is out of the image");
  return found;
}

}  // namespace microinjection
