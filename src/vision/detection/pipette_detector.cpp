#include "vision/detection/pipette_detector.h"

#include <algorithm>
#include <cmath>

#include "vision/detection/axis_fit.h"
#include "vision/detection/holding_mouth.h"
#include "vision/detection/pipette_end.h"
#include "vision/detection/pipette_outline.h"

namespace microinjection {
namespace {

constexpr int kAxes = 5, kHoldingAxes = 8;
constexpr double kWider = 1.38;                            // ratio of two outlines' widths that tells them apart
constexpr double kLeastClearness = 3;                      // of the shared edges at the end
constexpr int kAxisRows = 160;                             // px behind the end, whose symmetry gives the axis
constexpr double kAcross = 1.5;                            // px, blur of the derivative across the axis
constexpr double kEdgesEnded = 0.15, kSharedEnded = 0.25;  // see coarseEnd()
constexpr double kEmpty = 8;                               // clearness of a tip before an empty background
constexpr double kAxisMargin = 24;                         // px beside an outline, that shows the symmetry
constexpr double kWidestPoint = 14;                        // px from the axis, that a tip is looked for in
constexpr double kTube = 0.1;                              // widening of a tube whose profile stays the same, at most
constexpr double kAgree = 6;                               // px, between two ways to see a tip's end
constexpr double kApart = 0.25;  // standard deviation of an end over the distance between two ways to see it
constexpr double kUnclear = 3;   // px, standard deviation of an end that needs a second witness
constexpr int kFirstShift = 24, kShift = 8;  // px, that an axis may be off
constexpr double kMargin = 6;                // px beside an outline
constexpr double kCoarseLength = 430;        // rows of the strip that shows a whole holding pipette
constexpr int kCoarseShift = 8;              // columns of it, that the axis may be off
constexpr int kBehindMouth = 8;              // rows of it, that a mouth must leave before the frame's other border
constexpr double kNarrowestHolding = 12;     // px, half width
constexpr double kHoldingStep = 2;           // px, of the strip that gives the axis of a holding pipette
constexpr double kNearMouth = 8, kMouthRows = 36, kMouthBlur = 1.3;  // px, of the strip that shows the mouth
constexpr double kWitnessReach = 14;                                 // px beside lips that are not clear
constexpr int kMouthMargin = 18;                                     // px beside the walls
constexpr double kSureClearness = 9;                                 // of a tip
constexpr double kSureSymmetry = 0.9;                                // of the edges near a tip
constexpr double kLeastSymmetry = 0.5;                               // of the edges of a whole pipette

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

/// @param along, across  px, standard deviations of the end
void setCovariance(PipetteDetection& found, double along, double across) {
  const double c = std::cos(found.direction), s = std::sin(found.direction);
  Eigen::Matrix2d turn;
  turn << c, -s, s, c;
  found.covariance = turn * Eigen::Vector2d(along * along, across * across).asDiagonal() * turn.transpose();
}

/// Row of a mouth whose lips are not clearly round: where an edge across ends both walls, if there is one.
double secondWitness(const PipetteStrip& strip, const HoldingMouth& mouth) {
  double slant = 0;
  const PipetteEnd edge = mouthNear(strip, mouth.row, mouth.half_width, kWitnessReach, slant);
  return edge.valid ? edge.row : mouth.row;
}

/// A cut tube ends at half of its profile. A point, or a tube that widens quickly, has no profile
/// that stays the same; it ends where its edges do. How far both are apart tells how certain each is.
PipetteEnd tipIn(const PipetteStrip& strip, int row, double reach, double half_width) {
  const int half = static_cast<int>(std::min(0.6 * half_width + kMargin, kWidestPoint));
  const PipetteEnd point = pointNear(strip, row, reach, half);
  if (!point.valid || point.clearness < kEmpty) {
    const PipetteEnd tube = tubeNear(strip, row, reach, half);
    const PipetteEnd fine = tube.valid ? tipNear(strip, tube.row, half) : tube;
    return fine.valid ? fine : tube;
  }
  const PipetteEnd cut = tipNear(strip, point.row, half);
  if (!cut.valid) return point;
  const bool tube = widening(strip, point.row, 2 * half) < kTube && std::abs(cut.row - point.row) < kAgree;
  PipetteEnd end = tube ? cut : point;
  end.deviation = std::hypot(end.deviation, kApart * (cut.row - point.row));
  return end;
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
  // A finer search costs four times as much: only for pipettes of which too little is seen.
  for (; search.finer < 2 && !best.finding.hasValues(); ++search.finer) {
    for (const PipetteAxis& axis : findPipetteAxes(frame, search, config_.kind == "holding" ? kHoldingAxes : kAxes)) {
      if (best.finding.isFound() && outlineAt(axis, best.end) < kWider * best.half_width) continue;
      take(best, measure(frame, axis));
      if (best.finding.isFound() && config_.kind == "injection") return best;
    }
  }
  return best;
}

/// A thick wall is symmetric to an axis of its own: the widest outline is that of the whole holding
/// pipette. Of injection pipettes that are not certain the most symmetric one is taken.
void PipetteDetector::take(PipetteDetection& best, const PipetteDetection& found) const {
  if (!found.finding.hasValues()) {
    if (!best.finding.hasValues()) best.finding = found.finding;
    return;
  }
  const bool holding = config_.kind == "holding";
  const bool better = holding ? found.half_width > kWider * best.half_width : found.symmetry > best.symmetry;
  const bool surer = found.finding.isFound() && !best.finding.isFound();
  const bool less_sure = !found.finding.isFound() && best.finding.isFound();
  if (!best.finding.hasValues() || surer || (better && !less_sure)) best = found;
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
  if (config_.kind == "injection") return refine(frame, axis, previous.end, reach + 10);
  axis.point = previous.end;
  return refineHolding(frame, axis, previous.end, reach + kNearMouth, 1);
}

/// The outline gives the axis its width; what is symmetric to the axis of one wall only is none.
PipetteDetection PipetteDetector::measureHolding(const Frame& frame, PipetteAxis axis) const {
  PipetteDetection none;
  const double length = std::hypot(frame.width(), frame.height());
  PipetteStrip::Shape shape;
  shape.step = std::clamp(std::round(length / kCoarseLength), 2.0, 4.0);
  shape.rows = static_cast<int>(length / shape.step);
  shape.half = static_cast<int>(0.5 * config_.widest / shape.step) + kCoarseShift;
  PipetteOutline outline;
  for (int round = 0; round < 2; ++round) {
    const cv::Point2d border = entry(frame, axis);
    shape.direction = axis.direction;
    shape.origin =
        border - (shape.rows - 1) * shape.step * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
    const PipetteStrip strip(frame, shape, 1.0, 1.5);
    outline = findOutline(strip, kNarrowestHolding / shape.step);
    none.finding = Finding::notFound("no pipette: an axis without two walls in the image");
    if (!outline.valid || outline.last < kBehindMouth) return none;
    const AxisFit fit =
        fitAxis(strip, outline.last, shape.rows - outline.last, 1.25 * outline.at(outline.last) + 6, kCoarseShift);
    if (round == 0 && fit.valid) {
      axis.point = strip.point(outline.last, fit.offset);
      axis.direction += std::atan(fit.slant);
      continue;
    }
    axis.point = strip.point(outline.last, 0);
    break;
  }
  none.finding = Finding::notFound("no pipette: its walls are not symmetric");
  if (outline.symmetry < kLeastSymmetry) return none;
  axis.half_width = outline.at(outline.last) * shape.step;
  axis.taper = outline.growth;
  return refineHolding(frame, axis, axis.point, 0.5 * axis.half_width + 24, 2);
}

PipetteDetection PipetteDetector::refineHolding(const Frame& frame, PipetteAxis axis, const cv::Point2d& end,
                                                double reach, int rounds) const {
  PipetteDetection found;
  found.finding = Finding::notFound("no pipette: its end is not clear");
  cv::Point2d place = end;
  AxisFit fit;
  HoldingMouth mouth;
  for (int round = 0; round < rounds; ++round) {
    const double half_width = std::max(4.0, outlineAt(axis, place));
    PipetteStrip::Shape shape;
    shape.step = kHoldingStep;
    shape.direction = axis.direction;
    shape.origin = place;
    shape.rows = static_cast<int>(kAxisRows / kHoldingStep) + 2;
    const double wide = 1.25 * half_width + kAxisMargin;
    shape.half = static_cast<int>(wide / kHoldingStep) + kShift + 2;
    const PipetteStrip strip(frame, shape, kAcross / kHoldingStep, 0.7);
    fit = fitAxis(strip, 2, shape.rows, wide / kHoldingStep, kShift);
    if (!fit.valid) return found;
    axis.point = strip.point(2, fit.offset);
    axis.direction += std::atan(fit.slant);
    const double back = (round == 0 ? reach : kNearMouth) + 10;
    PipetteStrip::Shape straight;
    straight.direction = axis.direction;
    const cv::Point2d u(std::cos(axis.direction), std::sin(axis.direction));
    straight.origin = axis.point + ((place - axis.point).dot(u) - back) * u;
    straight.rows = static_cast<int>(back + 0.5 * half_width + kMouthRows);
    straight.half = static_cast<int>(half_width) + kMouthMargin;
    const PipetteStrip aligned(frame, straight, kMouthBlur, kMouthBlur);
    mouth = findMouth(aligned, back, back - 10, half_width);
    if (!mouth.valid) return found;
    if (!mouth.doubt.empty()) mouth.row = secondWitness(aligned, mouth);
    place = aligned.point(mouth.row, 0);
    axis.point = place;
    axis.half_width = mouth.half_width;
  }
  found.end = place;
  found.direction = axis.direction;
  found.direction_deviation = fit.slant_deviation;
  found.half_width = mouth.half_width;
  found.taper = axis.taper;
  found.symmetry = fit.symmetry;
  found.clearness = mouth.score;
  setCovariance(found, mouth.deviation, fit.offset_deviation * kHoldingStep);
  found.finding = mouth.doubt.empty() ? Finding::found() : Finding::uncertain(mouth.doubt);
  if (!frame.contains(found.end, 2)) found.finding = Finding::notFound("no pipette: its end is out of the image");
  return found;
}

PipetteDetection PipetteDetector::measure(const Frame& frame, const PipetteAxis& axis) const {
  if (config_.kind == "holding") return measureHolding(frame, axis);
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
  // Before an empty background all edges end; before a cell those that are symmetric to the axis.
  const std::vector<double> half = outlines(strip, axis, 1.2, kMargin);
  PipetteEnd end = coarseEnd(strip, allEdges(strip, half), kEdgesEnded);
  if (!end.valid || end.clearness < kLeastClearness) end = coarseEnd(strip, sharedEdges(strip, half), kSharedEnded);
  PipetteDetection none;
  none.finding = Finding::notFound("no pipette: an axis without an end in the image");
  if (!end.valid || end.clearness < kLeastClearness) return none;
  return refine(frame, axis, strip.point(end.row, 0), 60);
}

PipetteDetection PipetteDetector::refine(const Frame& frame, PipetteAxis axis, const cv::Point2d& end,
                                         double reach) const {
  PipetteDetection found;
  found.finding = Finding::notFound("no pipette: its end is not clear");
  cv::Point2d place = end;
  AxisFit fit;
  PipetteEnd last;
  double half_width = 0;
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
    const PipetteStrip aligned(frame, straight, kAcross, 1.0);
    last = tipIn(aligned, row, round == 0 ? reach : 30, half_width);
    if (!last.valid) return found;
    axis.half_width = half_width;
    place = aligned.point(last.row, 0);
  }
  found.end = place;
  found.direction = axis.direction;
  found.direction_deviation = fit.slant_deviation;
  found.half_width = half_width;
  found.taper = axis.taper;
  found.symmetry = fit.symmetry;
  found.clearness = last.clearness;
  setCovariance(found, last.deviation, fit.offset_deviation);
  found.finding = last.deviation > kUnclear ? Finding::uncertain("the pipette's end is not clear") : Finding::found();
  if (found.clearness < kSureClearness)
    found.finding = Finding::uncertain("the tip is not clear before its background");
  if (found.symmetry < kSureSymmetry) found.finding = Finding::uncertain("the pipette's walls are not symmetric");
  if (!frame.contains(found.end, 2)) found.finding = Finding::notFound("no pipette: its end is out of the image");
  return found;
}

}  // namespace microinjection
