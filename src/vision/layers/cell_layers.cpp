#include "vision/layers/cell_layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "vision/border/border_search.h"
#include "vision/frame/ellipse.h"
#include "vision/frame/frame.h"
#include "vision/frame/polar_map.h"
#include "vision/layers/fitted_layers.h"
#include "vision/layers/zona_inner.h"

namespace microinjection {
namespace {

constexpr int kOwnLine = 3;             // px, that the line of a border is wide, to both sides
constexpr int kLeastReach = 15;         // px
constexpr double kReachOfRadius = 0.1;  // of the radius
constexpr int kThird = 2;
constexpr double kSlopeSmoothing = 1;  // px

/// Size of a sector's mean slope at a column.
double slopeOfSector(const PolarMap& map, int sector, int column) {
  double sum = 0;
  for (int ray = sector * kRaysOfAveragedSector; ray < (sector + 1) * kRaysOfAveragedSector; ++ray)
    sum += map.slope().at<float>(ray, column);
  return std::abs(sum) / kRaysOfAveragedSector;
}

double largestSlope(const PolarMap& map, int sector, int first, int last) {
  double largest = 0;
  for (int column = first; column < last; ++column) largest = std::max(largest, slopeOfSector(map, sector, column));
  return largest;
}

/// How clear lines outside of a border are, over the border's own: the third of twelve sectors, so that pipettes do not
/// count. Lines are outside from 6 px to a tenth of the radius, at least 15 px. DIC shades a line on two sides only,
/// and an ellipse that is on the outer line of one side and on the inner line of the other has the outer one outside.
/// There it is above 0.25; about the right border it is below 0.2.
double linesOutside(const Frame& frame, const Ellipse& border) {
  const int reach = std::max(kLeastReach, static_cast<int>(kReachOfRadius * 0.5 * border.meanDiameter()));
  const int columns = kOwnLine + reach + 1;
  const PolarMap map(frame, border,
                     {-kOwnLine, static_cast<double>(reach), columns, kAveragedSectors * kRaysOfAveragedSector},
                     kSlopeSmoothing);
  double own = 0;
  std::array<double, kAveragedSectors> outside{};
  for (int sector = 0; sector < kAveragedSectors; ++sector) {
    own = std::max(own, largestSlope(map, sector, 0, 2 * kOwnLine + 1));
    outside[sector] = largestSlope(map, sector, 3 * kOwnLine, columns);
  }
  std::nth_element(outside.begin(), outside.begin() + kThird, outside.end(), std::greater<>());
  return own > 0 ? outside[kThird] / own : 0;
}

constexpr int kFineRays = 180;
constexpr double kOutermost = 1.65;                                 // of the ooplasm's radius, a zona's outer border
constexpr double kFaded = 0.25;                                     // of a border's contrast, when it is lost
constexpr double kLargestInside = 0.93;                             // ratio of a border inside of the main one, at most
constexpr double kFollowedCoverage = 0.55, kRingConsistency = 0.6;  // of a border that is followed, and of a clear ring
constexpr double kRingContrast = 0.2;                               // of the border inside, of a clear ring
constexpr double kAsClearAsMain = 0.8;  // of the main border's strength: an inner border as clear as the main one
constexpr double kZonaPlace = 0.5;      // of the zona's outer border in its dark rim, see refineBorder()
constexpr double kInnerPlace = 0.5;     // of the zona's inner border
constexpr double kWhole = 0.92;         // coverage of a border without a dent
constexpr double kOff = 0.8;            // px, of a border from where it was searched
constexpr double kBesideRim = 2;        // px, from the rim, that is another border
constexpr double kSharpRim = 6;         // px, line of a zona in focus, at most
constexpr double kLeastResidual = 0.5, kMostResidual = 0.0025;  // px; of the diameter: of a sure ellipse
constexpr double kSameLineResidual = 0.004;                     // of the diameter, of one line all round
constexpr double kThickerThanHalo = 1.15;  // of the diameter, a zona: the halo of a vesicle is like a thin one
constexpr double kOoplasmPlace = 1.0;      // of the ooplasm's: the rim is refracted beside it
constexpr double kMixedLines = 0.23;       // see linesOutside()
constexpr double kWidestOoplasmRim = 0.2;  // of the radius

/// @param rim  px, widest dark rim
CellBorder refined(const Frame& frame, const CellBorder& border, double place, double rim) {
  if (!border.finding.hasValues()) return border;
  const double radius = 0.5 * border.ellipse.meanDiameter();
  const double blur = std::clamp(0.006 * radius, 1.0, 2.5);
  const double window = std::max(3.0, 0.04 * radius);
  CellBorder fine = refineBorder(frame, border, {rim, place}, window, blur, kFineRays);
  // The flanks are searched near their mean places: a first ellipse that was off displaces them.
  const double off = cv::norm(fine.ellipse.centre - border.ellipse.centre) +
                     (fine.ellipse.semi_axes - border.ellipse.semi_axes).cwiseAbs().maxCoeff() - fine.shift;
  if (off >= kOff && fine.coverage <= kWhole) {
    fine.ellipse = scaled(fine.ellipse, 1 + fine.shift / radius);
    fine = refineBorder(frame, fine, {rim, place}, window, blur, kFineRays);
  }
  fine.line = fine.ellipse;
  return fine;
}

/// The zona's inner border as a line of its own, for cells that the joint fit does not describe. Uncertain.
CellBorder innerBorder(const Frame& frame, const CellLayers& layers, const Ellipse& first, ContrastMode mode) {
  const double outer = radiusOf(layers.zona_outer), inner = radiusOf(layers.ooplasm);
  const Ellipse rim = scaled(first, 1 + 2 * std::max(2.0, 0.02 * outer) / first.meanDiameter());
  CellBorder border;
  if (rim.meanDiameter() < 0.96 * layers.zona_outer.ellipse.meanDiameter()) {
    const PolarMap map = mapAbout(frame, layers.zona_outer.ellipse, std::max(0.6, inner / outer - 0.05), 0.97);
    border = bestBorder(frame, map, mode, outer, {rim, {}, 0, kFreeChange});
  }
  if (isSecondBorder(border) && radiusOf(border) > inner + layers.ooplasm.shift + kBesideRim)
    border = refined(frame, border, kInnerPlace, 0.25 * (outer - inner));
  else
    border = findZonaInner(frame, layers.zona_outer, layers.ooplasm);
  if (!border.finding.hasValues()) {
    border = layers.ooplasm;
    border.ellipse = scaled(layers.ooplasm.ellipse, 1 + 0.5 * layers.ooplasm.rim / inner);
  }
  border.finding = Finding::uncertain("the zona's inner border is one of several lines");
  return border;
}

/// Takes the certainty from borders whose places the image may have displaced.
void warn(CellLayers& layers) {
  const auto doubt = [](CellBorder& border, const std::string& reason, bool centred) {
    if (!border.finding.isFound()) return;
    border.finding = Finding::uncertain(reason);
    border.centred = centred;
  };
  CellBorder* const all[] = {&layers.zona_outer, &layers.zona_inner, &layers.ooplasm};
  const bool zona = layers.zona_outer.finding.hasValues();
  if (zona && layers.ooplasm.rim == 0)
    doubt(layers.ooplasm, "the ooplasm's dark rim is not seen: its border is up to a rim off", true);
  CellBorder& outer = layers.zona_outer;
  if (zona && outer.rim == 0 && outer.finding.isFound()) {
    doubt(outer, "the zona's outer border is not a dark line", true);
    // Whoever knows that the zona ends there knows the line, unless it is another one on each side or a halo.
    outer.which_line = outer.polarity != Polarity::kEither &&
                       outer.residual < kSameLineResidual * outer.ellipse.meanDiameter() &&
                       outer.ellipse.meanDiameter() > kThickerThanHalo * layers.ooplasm.ellipse.meanDiameter();
  }
  for (CellBorder* border : all) {
    if (border->polarity == Polarity::kEither) doubt(*border, "DIC shades borders: they are displaced", false);
    if (border->residual > std::max(kLeastResidual, kMostResidual * border->ellipse.meanDiameter())) {
      doubt(*border, "the border is not an ellipse", false);
    }
    if (layers.zona_outer.rim > kSharpRim) doubt(*border, "the cell is out of focus: its borders are displaced", true);
  }
}

void doubtRinged(CellBorder& outer) {
  outer.finding = Finding::uncertain("a ring is seen outside of the border: it may be the zona's inner one");
  outer.centred = outer.which_line = false;
}

/// Takes the certainty from an outer border that has a ring about it: it may be the zona's inner one.
void doubtWithinRing(const Frame& frame, ContrastMode mode, CellBorder& outer, double largest) {
  const double limit = std::min(kOutermost, largest / outer.ellipse.meanDiameter());
  // Out of focus a border has fringes about it.
  const bool trusted = outer.finding.isFound() || (outer.centred && outer.rim == 0);
  if (!trusted || limit < kBorderGap + 0.03) return;
  const CellBorder beyond = searchBand(frame, outer, kBorderGap, limit, mode, kOutwards);
  const bool clear = beyond.consistency > kRingConsistency && beyond.contrast > kRingContrast * outer.contrast;
  if (!isRing(beyond) || !clear || beyond.polarity == Polarity::kFalling) return;
  outer.ringed = true;
  doubtRinged(outer);
}

/// Takes the certainty in DIC from an outer border that is another line on each side.
void doubtMixedLines(const Frame& frame, ContrastMode mode, CellBorder& outer) {
  if (mode != ContrastMode::kDic || !outer.finding.isFound() || linesOutside(frame, outer.ellipse) < kMixedLines)
    return;
  outer.finding = Finding::uncertain("in DIC the border may be another line on each side");
  outer.centred = false;
  outer.which_line = true;
}

void doubtOuter(const Frame& frame, ContrastMode mode, CellBorder& outer, double largest) {
  doubtWithinRing(frame, mode, outer, largest);
  doubtMixedLines(frame, mode, outer);
}

}  // namespace

CellBorder findMainBorder(const Frame& frame, const cv::Point2d& centre, double radius, ContrastMode mode) {
  Ellipse base{centre, {radius, radius}, 0};
  CellBorder best;
  for (int round = 0; round < 2; ++round) {
    const PolarMap map(frame, base, {-0.5 * radius, 0.5 * radius, kSearchColumns, kSearchRays}, kSearchSmoothing);
    // Dark inside: the rim of a cell is dark in every contrast mode. A border that is only bright inside is a
    // bubble's middle or a pipette's lumen.
    const Polarity polarity = mode == ContrastMode::kDic ? Polarity::kEither : Polarity::kRising;
    const CellBorder border = findBorder(frame, map, polarity, {}, scaleOf(frame, map), toleranceFor(radius));
    if (!border.finding.hasValues() || borderScore(border) < 0.5 * borderScore(best)) break;
    best = border;
    base = border.ellipse;
  }
  return best;
}

CellLayers findLayers(const Frame& frame, const CellBorder& main, ContrastMode mode, double largest) {
  CellLayers layers;
  layers.main = main;
  const double limit = std::min(kOutermost, largest / main.ellipse.meanDiameter());
  const std::vector<CellBorder> outside = bordersOutside(frame, main, limit, mode);
  const CellBorder inside = searchBand(frame, main, 0.6, kLargestInside, mode);
  const CellBorder beyond =
      outside.empty() ? searchBand(frame, main, kBorderGap, limit, mode, kOutwards) : CellBorder();
  CellBorder ooplasm = main;
  if (!outside.empty()) {
    layers.zona_outer = outside.back();
  } else if (isSecondBorder(inside) && inside.polarity == main.polarity &&
             inside.strength > kAsClearAsMain * main.strength) {
    layers.zona_outer = main;
    ooplasm = inside;
  }
  if (!layers.zona_outer.finding.hasValues() && isRing(inside)) {
    CellLayers within = layers;
    within.zona_outer = refined(frame, main, kZonaPlace, 0.35 * (radiusOf(main) - radiusOf(inside)));
    within.ooplasm = refined(frame, inside, kOoplasmPlace, kWidestOoplasmRim * radiusOf(inside));
    if (fitLayersTo(frame, mode, within) && within.ooplasm.finding.isFound()) {
      doubtOuter(frame, mode, within.zona_outer, largest);
      return within;
    }
  }
  if (!layers.zona_outer.finding.hasValues()) {
    layers.ooplasm = refined(frame, ooplasm, 0, 0);
    layers.zona_outer = faintBorder(frame, layers.ooplasm, kBorderGap, limit * radiusOf(main), mode);
  }
  if (!layers.zona_outer.finding.hasValues()) {
    warn(layers);
    const bool ring = isRing(inside) || (isSecondBorder(inside) && inside.significance > kBorderSignificance) ||
                      (isRing(beyond) && beyond.polarity != Polarity::kFalling);
    // The ooplasm is not always in the middle of its zona: the centre is in doubt too.
    if (ring && layers.ooplasm.finding.isFound())
      layers.ooplasm.finding = Finding::uncertain("a faint second ring is seen: this may be a zona's border");
    return layers;
  }
  const double gap = radiusOf(layers.zona_outer) - radiusOf(ooplasm);
  layers.ooplasm = refined(frame, ooplasm, kOoplasmPlace, std::min(kWidestOoplasmRim * radiusOf(ooplasm), 0.8 * gap));
  layers.zona_outer = refined(frame, layers.zona_outer, kZonaPlace, 0.35 * gap);
  warn(layers);
  if (!fitLayersTo(frame, mode, layers)) layers.zona_inner = innerBorder(frame, layers, ooplasm.ellipse, mode);
  doubtOuter(frame, mode, layers.zona_outer, largest);
  return layers;
}

namespace {

CellBorder followBorder(const Frame& frame, const CellBorder& previous, const cv::Point2d& moved, double room,
                        double place, double rim) {
  if (!previous.finding.hasValues()) return {};
  CellBorder base = previous;
  base.ellipse = previous.line;
  base.ellipse.centre += moved;
  // The flank that is searched is at the outer end of the rim.
  const double radius = radiusOf(previous), flank = 1 + place * previous.rim / radius;
  base.ellipse = scaled(base.ellipse, flank);
  const PolarMap map(frame, base.ellipse, {-room, room, std::max(13, static_cast<int>(2 * room) + 1), kSearchRays},
                     2.0);
  const CellBorder found = findBorder(frame, map, previous.polarity, {}, scaleOf(frame, map), toleranceFor(radius));
  const bool faded = found.contrast < kFaded * previous.contrast;
  if (!found.finding.hasValues() || found.coverage < kFollowedCoverage || faded) return {};
  CellBorder fine = refined(frame, found, place, rim);
  fine.strength = previous.strength;
  fine.contrast = previous.contrast;
  fine.consistency = found.consistency;
  return fine;
}

}  // namespace

CellLayers followLayers(const Frame& frame, const CellLayers& previous, ContrastMode mode, double reach) {
  CellLayers layers;
  const bool zona = previous.zona_outer.finding.hasValues();
  const double gap = zona ? radiusOf(previous.zona_outer) - radiusOf(previous.ooplasm) : 0;
  const double place = zona ? kOoplasmPlace : 0;
  const double rim = zona ? std::min(kWidestOoplasmRim * radiusOf(previous.ooplasm), 0.8 * gap) : 0;
  layers.ooplasm = followBorder(frame, previous.ooplasm, {0, 0}, reach + 4, place, rim);
  if (!layers.ooplasm.finding.hasValues()) return layers;
  // What was doubtful in the frame before is so here.
  if (previous.ooplasm.finding.verdict == Verdict::kUncertain) {
    layers.ooplasm.finding = previous.ooplasm.finding;
    layers.ooplasm.centred = previous.ooplasm.centred;
  }
  layers.main = layers.ooplasm;
  // The clearest border tells how far the cell moved; the others are then near.
  const cv::Point2d moved = layers.ooplasm.line.centre - previous.ooplasm.line.centre;
  layers.zona_outer = followBorder(frame, previous.zona_outer, moved, 6, kZonaPlace, 0.35 * gap);
  requireSameLine(zona ? previous.zona_outer : previous.ooplasm, zona ? layers.zona_outer : layers.ooplasm);
  warn(layers);
  if (!zona || !layers.zona_outer.finding.hasValues()) return layers;
  // The zona keeps its thickness from frame to frame.
  layers.zona_inner = previous.zona_inner;
  layers.zona_inner.ellipse.centre += layers.zona_outer.line.centre - previous.zona_outer.line.centre;
  refitLayersTo(frame, mode, previous, layers);
  doubtMixedLines(frame, mode, layers.zona_outer);
  layers.zona_outer.ringed = previous.zona_outer.ringed;
  if (layers.zona_outer.ringed) doubtRinged(layers.zona_outer);
  return layers;
}

}  // namespace microinjection
