#include "vision/pipette/injection_pipette.h"

#include <algorithm>
#include <cmath>

#include "vision/pipette/axis_fit.h"
#include "vision/pipette/pipette_end.h"
#include "vision/pipette/tip_fit.h"
#include "vision/pipette/tip_outline.h"
#include "vision/pipette/tip_walls.h"

namespace microinjection {
namespace {

constexpr double kLeastClearness = 3;                      // of the shared edges at the end
constexpr double kEdgesEnded = 0.15, kSharedEnded = 0.25;  // see coarseEnd()
constexpr double kEmpty = 8;                               // clearness of a tip before an empty background
constexpr double kWidestPoint = 14;                        // px from the axis, that a tip is looked for in
constexpr double kTube = 0.1;                              // widening of a tube whose profile stays the same, at most
constexpr double kEndsAgree = 6;                           // px, between two ways to see a tip's end
constexpr double kDeviationPerGap = 0.25;  // standard deviation of an end over the distance between two ways to see it
constexpr double kThinnestTip = 4, kWidestTip = 40, kWidestSure = 26;  // px, half widths
constexpr double kAhead = 48;         // px behind the end, whose half width is that of the strips
constexpr int kFirstShift = 24;       // px, that the first axis may be off
constexpr double kOutlineMargin = 6;  // px beside an outline
constexpr double kSureClearness = 9;  // of a tip
constexpr double kLeastTipSymmetry = 0.83, kSureTipSymmetry = 0.93;  // of the edges near a tip
constexpr int kRefinements = 3;
constexpr double kFitBehind = 48;  // px before an end, in the strip of its fit
constexpr int kFitBefore = 18;     // px of the background that the fit needs
constexpr int kFitShaft = 14;      // px of the shaft
constexpr int kFitRows = 110, kFitHalf = 24;
constexpr double kFitBlur = 0.4;                  // px
constexpr double kPlain = 0.5;                    // misfit of a fit before a plain background, at most
constexpr double kFitAgrees = 2;                  // px, of a fit and an edge before another background
constexpr double kSureEnd = 0.6;                  // px, of an end
constexpr double kSureCompressed = 0.25;          // px, the same of an end in a compressed image
constexpr double kFarEnd = 3, kSureFarEnd = 0.4;  // px, from where the edges end, and the deviation of an end that far
constexpr double kUnclear = 0.0019;               // of the frame's width, deviation of an end before nothing else
constexpr double kNothingElse = 40;               // clearness of an end before nothing else
constexpr double kNoWitness = 3;                  // misfit of a fit that describes nothing
constexpr double kThin = 7, kThinClear = 45;      // px, half width; clearness of such an end, if it does not go on
constexpr double kWallsKept = 0.15;               // of the walls' edges, that are left near an end
constexpr double kShaded = 0.2;                   // of walls that are not alike, as in DIC
constexpr double kThinShaded = 7;                 // px, half width of a profile that such walls displace
constexpr double kOneSided = 0.8;                 // shading of what is on one side of a needle only

std::vector<double> outlines(const PipetteStrip& strip, const PipetteAxis& axis, double factor, double margin) {
  std::vector<double> half;
  for (int row = 0; row < strip.rows(); ++row) {
    half.push_back((factor * axis.outlineAt(strip.point(row, 0)) + margin) / strip.shape().step);
  }
  return half;
}

/// A cut tube ends at half of its profile. A point, or a tube that widens quickly, has no profile
/// that stays the same; it ends where its edges do. How far both are apart tells how certain each is.
PipetteEnd tipIn(const PipetteStrip& strip, int row, double reach, double half_width) {
  const int half = static_cast<int>(std::min(0.6 * half_width + kOutlineMargin, kWidestPoint));
  const PipetteEnd point = pointNear(strip, row, reach, half);
  if (!point.valid || point.clearness < kEmpty) {
    const PipetteEnd tube = tubeNear(strip, row, reach, half);
    const PipetteEnd fine = tube.valid ? tipNear(strip, tube.row, half) : tube;
    return fine.valid ? fine : tube;
  }
  const PipetteEnd cut = tipNear(strip, point.row, half);
  if (!cut.valid) return point;
  const bool tube = widening(strip, point.row, 2 * half) < kTube && std::abs(cut.row - point.row) < kEndsAgree;
  PipetteEnd end = tube ? cut : point;
  end.deviation = std::hypot(end.deviation, kDeviationPerGap * (cut.row - point.row));
  return end;
}

/// Replaces the end by that of a fit to its grey values, where the background is plain enough for it: true.
bool fitEnd(const Frame& frame, const PipetteAxis& axis, const TipOutline& outline, PipetteDetection& found,
            double across) {
  PipetteStrip::Shape shape;
  shape.direction = axis.direction;
  const cv::Point2d u(std::cos(axis.direction), std::sin(axis.direction));
  shape.origin = axis.point + ((found.end - axis.point).dot(u) - kFitBehind) * u;
  shape.rows = kFitRows;
  shape.half = kFitHalf;
  const PipetteStrip strip(frame, shape, kFitBlur, kFitBlur);
  // Beyond the frame's border its last pixels are repeated, and a fit to these is too good.
  if (!strip.inside(static_cast<int>(kFitBehind) - kFitBefore) ||
      !strip.inside(static_cast<int>(kFitBehind) + kFitShaft)) {
    found.finding = Finding::uncertain("the tip is at the border of the frame");
    return false;
  }
  const TipFit fit = fitTip(strip, outline, kFitBehind, frame.noise());
  // Who describes nothing is no witness of where an end before nothing else is.
  if (fit.misfit > kNoWitness && found.clearness > kNothingElse) return false;
  if (!fit.valid || (fit.misfit > kPlain && (fit.ambiguous || std::abs(fit.row - kFitBehind) > kFitAgrees))) {
    found.finding = Finding::uncertain("the tip fades into its background");
    return false;
  }
  if (fit.misfit > kPlain) return false;
  found.end = strip.point(fit.row, 0);
  found.setCovariance(fit.deviation, across);
  if (found.clearness < kSureClearness) return true;
  if (fit.ambiguous) {
    found.finding = Finding::uncertain("in focus and out of focus the tip has other places");
    return true;
  }
  const double most = std::abs(fit.row - kFitBehind) > kFarEnd ? kSureFarEnd : kSureEnd;
  found.finding = fit.deviation > most ? Finding::uncertain("the tip fades into its background") : Finding::found();
  return true;
}

/// Takes the certainty from an end that the walls behind it contradict.
void doubtByWalls(const Frame& frame, PipetteDetection& found) {
  if (!found.finding.isFound()) return;
  const TipWalls walls = measureTipWalls(frame, found.end, found.direction);
  // Under a needle the borders of a cell are straight and symmetric to its axis, as an end is.
  if (walls.kept < kWallsKept && found.clearness < kNothingElse)
    found.finding = Finding::uncertain("the pipette's walls begin behind its end");
  // Both images of a thin needle in DIC are one, which is even about a place beside the axis.
  if (walls.shading > kShaded && walls.half_width < kThinShaded)
    found.finding = Finding::uncertain("the pipette is thin and shaded from one side, as in DIC");
  if (walls.shading > kOneSided) found.finding = Finding::uncertain("something lies beside the tip");
}

}  // namespace

PipetteDetection refineInjection(const Frame& frame, PipetteAxis axis, const cv::Point2d& end, double reach,
                                 double widest, int rounds) {
  PipetteDetection found;
  found.finding = Finding::notFound("no pipette: its end is not clear");
  cv::Point2d place = end;
  AxisFit fit;
  PipetteEnd last;
  TipOutline outline;
  for (int round = 0; round < rounds; ++round) {
    const double back = reach + 24;
    double half_width = std::max(
        kThinnestTip, axis.outlineAt(place + kAhead * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction))));
    PipetteStrip::Shape shape;
    shape.direction = axis.direction;
    shape.origin = place - back * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
    shape.rows = static_cast<int>(back) + kAxisRows + 40;
    const int most = round == 0 ? kFirstShift : kAxisShift;
    shape.half = static_cast<int>(std::min(0.5 * widest, 1.25 * half_width + kAxisMargin)) + most + 2;
    const PipetteStrip strip(frame, shape, kAxisBlur, 1.0);
    const int row = static_cast<int>(back);
    fit = fitAxis(strip, row + 4, kAxisRows, 1.25 * half_width + kAxisMargin, most);
    if (!fit.valid) return found;
    // The strip of the axis as it is now.
    axis.point = strip.point(row + 4, fit.offset);
    axis.direction += std::atan(fit.slant);
    PipetteStrip::Shape straight = shape;
    straight.direction = axis.direction;
    straight.origin = axis.point - (back + 4) * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
    const PipetteStrip aligned(frame, straight, kAxisBlur, 1.0);
    // Lines of a whole shaft do not show how thin it is at its end.
    const TipOutline before = measureOutline(aligned, row, kWidestTip);
    if (before.valid) half_width = std::max(kThinnestTip, before.half_width + kAhead * before.growth);
    last = tipIn(aligned, row, round == 0 ? reach : 30, half_width);
    if (!last.valid) return found;
    place = aligned.point(last.row, 0);
    outline = measureOutline(aligned, last.row, kWidestTip);
    axis.point = place;
    if (outline.valid) axis.half_width = outline.half_width;
    if (outline.valid) axis.taper = outline.growth;
  }
  found.end = place;
  found.direction = axis.direction;
  found.direction_deviation = fit.slant_deviation;
  found.half_width = axis.half_width;
  found.taper = axis.taper;
  found.symmetry = fit.symmetry;
  found.clearness = last.clearness;
  found.setCovariance(last.deviation, fit.offset_deviation);
  found.finding = Finding::found();
  const double unclear = found.clearness < kNothingElse ? kSureEnd : kUnclear * frame.width();
  if (last.deviation > unclear) found.finding = Finding::uncertain("the pipette's end is not clear");
  if (found.clearness < kSureClearness)
    found.finding = Finding::uncertain("the tip is not clear before its background");
  const bool described = fitEnd(frame, axis, outline, found, fit.offset_deviation);
  if (!described && found.finding.isFound() && found.half_width < kThin && found.clearness < kThinClear)
    found.finding = Finding::uncertain("the pipette is thin, and may go on before the end that is seen");
  if (found.finding.isFound() && isCompressed(frame.noise()) && found.deviationAlong() > kSureCompressed)
    found.finding = Finding::uncertain("the image has no noise, as a compressed one, and the tip is not clear");
  if (found.half_width > kWidestSure) found.finding = Finding::uncertain("the pipette is too wide at its end");
  if (found.symmetry < kSureTipSymmetry) found.finding = Finding::uncertain("the pipette's walls are not symmetric");
  doubtByWalls(frame, found);
  if (found.symmetry < kLeastTipSymmetry) found.finding = Finding::notFound("no pipette: its walls are not symmetric");
  if (!frame.contains(found.end, 2)) found.finding = Finding::notFound("no pipette: its end is out of the image");
  return found;
}

PipetteDetection measureInjection(const Frame& frame, const PipetteAxis& axis, double widest) {
  // At half the resolution, with room for an axis that is a little off.
  const cv::Point2d border = axis.entry(frame);
  const double length = std::hypot(frame.width(), frame.height());
  PipetteStrip::Shape shape;
  shape.step = 2;
  shape.direction = axis.direction;
  shape.rows = static_cast<int>(length / shape.step);
  shape.origin = border - length * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
  shape.half = static_cast<int>(std::min(0.5 * widest, 1.2 * axis.outlineAt(border) + 16) / shape.step);
  const PipetteStrip strip(frame, shape, 1.0, 2.5);
  // Before an empty background all edges end; before a cell those that are symmetric to the axis.
  const std::vector<double> half = outlines(strip, axis, 1.2, kOutlineMargin);
  PipetteEnd end = coarseEnd(strip, allEdges(strip, half), kEdgesEnded);
  if (!end.valid || end.clearness < kLeastClearness) end = coarseEnd(strip, sharedEdges(strip, half), kSharedEnded);
  PipetteDetection none;
  none.finding = Finding::notFound("no pipette: an axis without an end in the image");
  if (!end.valid || end.clearness < kLeastClearness) return none;
  return refineInjection(frame, axis, strip.point(end.row, 0), 60, widest, kRefinements);
}

}  // namespace microinjection
