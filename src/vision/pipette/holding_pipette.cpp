#include "vision/pipette/holding_pipette.h"

#include <algorithm>
#include <cmath>

#include "vision/pipette/axis_fit.h"
#include "vision/pipette/holding_mouth.h"
#include "vision/pipette/pipette_end.h"
#include "vision/pipette/pipette_outline.h"

namespace microinjection {
namespace {

constexpr double kCoarseLength = 430;       // rows of the strip that shows a whole pipette
constexpr int kCoarseShift = 8;             // columns of it, that the axis may be off
constexpr int kBehindMouth = 8;             // rows of it, that a mouth must leave before the frame's other border
constexpr double kNarrowestPipette = 12;    // px, half width
constexpr double kLeastEdgeSymmetry = 0.5;  // of the edges of a whole pipette
constexpr double kAxisStripStep = 2;        // px, of the strip that gives the axis
constexpr double kNearMouth = 8, kMouthRows = 36, kMouthBlur = 1.3;  // px, of the strip that shows the mouth
constexpr double kWitnessReach = 14;                                 // px beside lips that are not clear
constexpr int kMouthMargin = 18;                                     // px beside the walls
constexpr double kMouthModel = 0.03;  // px, standard deviation along the axis beside that of the arcs
constexpr double kLeastMouthSymmetry = 0.7, kSureMouthSymmetry = 0.9;  // of the walls behind a mouth

/// Row of a mouth whose lips are not clearly round: where an edge across ends both walls, if there is one.
double secondWitness(const PipetteStrip& strip, const HoldingMouth& mouth) {
  double slant = 0;
  const PipetteEnd edge = mouthNear(strip, mouth.row, mouth.half_width, kWitnessReach, slant);
  return edge.valid ? edge.row : mouth.row;
}

}  // namespace

PipetteDetection refineHolding(const Frame& frame, PipetteAxis axis, const cv::Point2d& end, double reach, int rounds) {
  PipetteDetection found;
  found.finding = Finding::notFound("no pipette: its end is not clear");
  cv::Point2d place = end;
  AxisFit fit;
  HoldingMouth mouth;
  for (int round = 0; round < rounds; ++round) {
    const double half_width = std::max(4.0, axis.outlineAt(place));
    PipetteStrip::Shape shape;
    shape.step = kAxisStripStep;
    shape.direction = axis.direction;
    shape.origin = place;
    shape.rows = static_cast<int>(kAxisRows / kAxisStripStep) + 2;
    const double wide = 1.25 * half_width + kAxisMargin;
    shape.half = static_cast<int>(wide / kAxisStripStep) + kAxisShift + 2;
    const PipetteStrip strip(frame, shape, kAxisBlur / kAxisStripStep, 0.7);
    fit = fitAxis(strip, 2, shape.rows, wide / kAxisStripStep, kAxisShift);
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
  found.setCovariance(std::hypot(mouth.deviation, kMouthModel), fit.offset_deviation * kAxisStripStep);
  found.which_end = mouth.faint;
  found.finding = mouth.doubt.empty() ? Finding::found() : Finding::uncertain(mouth.doubt);
  if (found.symmetry < kSureMouthSymmetry) {
    found.which_end = false;
    found.finding = Finding::uncertain("the pipette's walls are not symmetric");
  }
  if (found.symmetry < kLeastMouthSymmetry)
    found.finding = Finding::notFound("no pipette: its walls are not symmetric");
  if (!frame.contains(found.end, 2)) found.finding = Finding::notFound("no pipette: its end is out of the image");
  return found;
}

/// The outline gives the axis its width; what is symmetric to the axis of one wall only is none.
PipetteDetection measureHolding(const Frame& frame, PipetteAxis axis, double widest) {
  PipetteDetection none;
  const double length = std::hypot(frame.width(), frame.height());
  PipetteStrip::Shape shape;
  shape.step = std::clamp(std::round(length / kCoarseLength), 2.0, 4.0);
  shape.rows = static_cast<int>(length / shape.step);
  shape.half = static_cast<int>(0.5 * widest / shape.step) + kCoarseShift;
  PipetteOutline outline;
  for (int round = 0; round < 2; ++round) {
    const cv::Point2d border = axis.entry(frame);
    shape.direction = axis.direction;
    shape.origin =
        border - (shape.rows - 1) * shape.step * cv::Point2d(std::cos(axis.direction), std::sin(axis.direction));
    const PipetteStrip strip(frame, shape, 1.0, 1.5);
    outline = findOutline(strip, kNarrowestPipette / shape.step);
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
  if (outline.symmetry < kLeastEdgeSymmetry) return none;
  axis.half_width = outline.at(outline.last) * shape.step;
  axis.taper = outline.growth;
  return refineHolding(frame, axis, axis.point, 0.5 * axis.half_width + 24, 2);
}

}  // namespace microinjection
