#include "vision/detection/cell_layers.h"

#include <algorithm>
#include <cmath>

#include "vision/detection/zona_inner.h"

namespace microinjection {
namespace {

constexpr int kRays = 96, kFineRays = 180, kColumns = 110;
constexpr double kSmoothing = 1.2;   // columns
constexpr double kOutermost = 1.65;  // of the ooplasm's radius, a zona's outer border
constexpr double kNear = 1.1, kNearStrength = 0.75;
constexpr double kFaded = 0.25;   // of a border's contrast, when it is lost
constexpr double kInside = 0.93;  // ratio of a border inside of the main one, at most
constexpr double kGap = 1.03;     // ratio of two borders' radii, at least
constexpr double kLeastCoverage = 0.55, kLeastConsistency = 0.6, kLeastStrength = 0.55;  // of a second border
constexpr double kLeastSignificance = 3;                                                 // of a second border
constexpr double kClear = 0.8;       // of the main border's strength: an inner border as clear as the main one
constexpr double kZonaPlace = 0.5;   // of the zona's outer border in its dark rim, see refineBorder()
constexpr double kInnerPlace = 0.5;  // of the zona's inner border
constexpr double kSharpRim = 6;      // px, line of a zona in focus, at most
constexpr double kLeastResidual = 0.5, kMostResidual = 0.0025;  // px; of the diameter: of a sure ellipse
constexpr double kApart = 2;                                    // px, from the rim, that is another border
constexpr double kOoplasmPlace = 1.0;                           // of the ooplasm's: the rim is refracted beside it
constexpr int kFreeChange = 4;                                  // columns from ray to ray
constexpr double kFreeGain = 0.07;                              // of strength, what a freer path must be better by
constexpr double kSure = 0.9;                                   // strength that needs no freer path
constexpr double kOutwards = 0.2;                               // see BorderBand
constexpr double kWidestRim = 0.2;                              // of the radius

std::vector<Polarity> polaritiesOf(const std::string& look) {
  if (look == "dic") return {Polarity::kEither};
  return {Polarity::kRising, Polarity::kFalling};
}

double toleranceFor(double radius) { return std::max(1.0, 0.03 * radius); }

PolarMap mapAbout(const Frame& frame, const Ellipse& base, double low, double high) {
  const double radius = 0.5 * base.meanDiameter();
  return {frame, base, {(low - 1) * radius, (high - 1) * radius, kColumns, kRays}, kSmoothing};
}

/// Scale of the map's slopes, and at least what noise makes of them.
double scaleOf(const Frame& frame, const PolarMap& map) {
  return std::max(slopeScale(map, 0, map.columns()), 0.2 * frame.noise());
}

CellBorder bestBorder(const Frame& frame, const PolarMap& map, const std::string& look, double radius,
                      const BorderBand& band = {}) {
  CellBorder best;
  for (const Polarity polarity : polaritiesOf(look)) {
    const CellBorder border = findBorder(frame, map, polarity, band, scaleOf(frame, map), toleranceFor(radius));
    if (worthOf(border) > worthOf(best)) best = border;
  }
  return best;
}

bool isSecondBorder(const CellBorder& border) {
  return border.finding.hasValues() && border.coverage >= kLeastCoverage && border.consistency >= kLeastConsistency &&
         border.strength >= kLeastStrength && border.outside < 0.5;
}

/// @param rim  px, widest dark rim
CellBorder refined(const Frame& frame, const CellBorder& border, double place, double rim) {
  if (!border.finding.hasValues()) return border;
  const double radius = 0.5 * border.ellipse.meanDiameter();
  const double blur = std::clamp(0.006 * radius, 1.0, 2.5);
  return refineBorder(frame, border, {rim, place}, std::max(3.0, 0.04 * radius), blur, kFineRays);
}

CellBorder searchBand(const Frame& frame, const CellBorder& main, double low, double high, const std::string& look,
                      double outwards = 0) {
  const double radius = 0.5 * main.ellipse.meanDiameter();
  const PolarMap map = mapAbout(frame, main.ellipse, low, high);
  const CellBorder border = bestBorder(frame, map, look, radius, {{}, {}, outwards});
  if (border.strength > kSure) return border;
  // A border about another centre moves more from ray to ray; so does a path of noise.
  const CellBorder freer = bestBorder(frame, map, look, radius, {{}, {}, outwards, kFreeChange});
  return freer.strength > border.strength + kFreeGain ? freer : border;
}

/// The same border searched again in a map about itself: the first map was about another one.
/// @param inner  px, radius of the next border inside
CellBorder settled(const Frame& frame, const CellBorder& border, double inner) {
  const double radius = 0.5 * border.ellipse.meanDiameter();
  const double half = std::clamp(0.5 * (radius - inner) / radius, 0.015, 0.1);
  const PolarMap map = mapAbout(frame, border.ellipse, 1 - half, 1 + half);
  const CellBorder again = findBorder(frame, map, border.polarity, {}, scaleOf(frame, map), toleranceFor(radius));
  return isSecondBorder(again) ? again : border;
}

double radiusOf(const CellBorder& border) { return 0.5 * border.ellipse.meanDiameter(); }

/// A zona has nearly the same thickness everywhere, so its inner border is straight in a map about the
/// outer one. It is outside of the ooplasm's rim.
CellBorder wholeInnerBorder(const Frame& frame, const CellLayers& layers, const std::string& look) {
  const double outer = radiusOf(layers.zona_outer), inner = radiusOf(layers.ooplasm);
  const double low = std::max(0.6, inner / outer - 0.05);
  const Ellipse rim = scaled(layers.main.ellipse, 1 + std::max(2.0, 0.02 * outer) / radiusOf(layers.main));
  if (rim.meanDiameter() >= 0.96 * layers.zona_outer.ellipse.meanDiameter()) return {};
  const PolarMap map = mapAbout(frame, layers.zona_outer.ellipse, low, 0.97);
  return bestBorder(frame, map, look, outer, {rim, {}, 0, kFreeChange});
}

/// The zona's inner border: all round, or as the line beside the ooplasm's rim. Where neither is seen,
/// the gap is thinner than the rim.
CellBorder innerBorder(const Frame& frame, const CellLayers& layers, const std::string& look) {
  const double gap = radiusOf(layers.zona_outer) - radiusOf(layers.ooplasm);
  CellBorder whole = wholeInnerBorder(frame, layers, look);
  const bool apart = radiusOf(whole) > radiusOf(layers.ooplasm) + layers.ooplasm.shift + kApart;
  const bool seen = isSecondBorder(whole) && apart;
  CellBorder border = findZonaInner(frame, layers.zona_outer, layers.ooplasm);
  if (seen) {
    whole = refined(frame, whole, kInnerPlace, 0.25 * gap);
    const bool agree = border.finding.hasValues() && std::abs(radiusOf(whole) - radiusOf(border)) < kApart;
    if (!agree) border.finding = whole.finding = Finding::uncertain("two lines may be the zona's inner border");
    if (!border.finding.isFound()) return whole;
  }
  if (border.finding.hasValues()) return border;
  border = layers.ooplasm;
  border.finding = Finding::uncertain("no gap between ooplasm and zona: the middle of the ooplasm's rim is given");
  border.ellipse = scaled(layers.ooplasm.ellipse, 1 + 0.5 * layers.ooplasm.rim / radiusOf(layers.ooplasm));
  return border;
}

/// Borders that are farther out, up to `limit` (ratio to the main one's radius): the last is the
/// zona's outer border, one before it the inner.
std::vector<CellBorder> bordersOutside(const Frame& frame, const CellBorder& main, double limit,
                                       const std::string& look) {
  std::vector<CellBorder> found;
  double low = kGap;
  while (low + 0.03 < limit && found.size() < 3) {
    const CellBorder next = searchBand(frame, main, low, limit, look, kOutwards);
    if (!isSecondBorder(next) || next.significance < kLeastSignificance) break;
    // Near another border a halo of it may look like one.
    const bool near = radiusOf(next) < kNear * radiusOf(found.empty() ? main : found.back());
    if (near && next.strength < kNearStrength) break;
    found.push_back(settled(frame, next, found.empty() ? radiusOf(main) : radiusOf(found.back())));
    low = radiusOf(next) / radiusOf(main) + 0.03;
  }
  return found;
}

/// Takes the certainty from borders whose places the image may have displaced.
void warn(CellLayers& layers) {
  const auto doubt = [](CellBorder& border, const std::string& reason) {
    if (border.finding.isFound()) border.finding = Finding::uncertain(reason);
  };
  CellBorder* const all[] = {&layers.zona_outer, &layers.zona_inner, &layers.ooplasm};
  const bool zona = layers.zona_outer.finding.hasValues();
  if (zona && layers.ooplasm.rim == 0)
    doubt(layers.ooplasm, "the ooplasm's dark rim is not seen: its border is up to a rim off");
  if (zona && layers.zona_outer.rim == 0) doubt(layers.zona_outer, "the zona's outer border is not a dark line");
  for (CellBorder* border : all) {
    if (layers.zona_outer.rim > kSharpRim) doubt(*border, "the cell is out of focus: its borders are displaced");
    if (border->polarity == Polarity::kEither) doubt(*border, "DIC shades borders: they are displaced");
    if (border->residual > std::max(kLeastResidual, kMostResidual * border->ellipse.meanDiameter())) {
      doubt(*border, "the border is not an ellipse");
    }
  }
}

}  // namespace

CellBorder findMainBorder(const Frame& frame, const cv::Point2d& centre, double radius, const std::string& look) {
  Ellipse base{centre, {radius, radius}, 0};
  CellBorder best;
  for (int round = 0; round < 2; ++round) {
    const PolarMap map(frame, base, {-0.5 * radius, 0.5 * radius, kColumns, kRays}, kSmoothing);
    // Dark inside: the rim of a cell is dark in every look. A border that is only bright inside is a
    // bubble's middle or a pipette's lumen.
    const Polarity polarity = look == "dic" ? Polarity::kEither : Polarity::kRising;
    const CellBorder border = findBorder(frame, map, polarity, {}, scaleOf(frame, map), toleranceFor(radius));
    if (!border.finding.hasValues() || worthOf(border) < 0.5 * worthOf(best)) break;
    best = border;
    base = border.ellipse;
  }
  return best;
}

CellLayers findLayers(const Frame& frame, const CellBorder& main, const std::string& look, double largest) {
  CellLayers layers;
  layers.main = main;
  const double limit = std::min(kOutermost, largest / main.ellipse.meanDiameter());
  const std::vector<CellBorder> outside = bordersOutside(frame, main, limit, look);
  const CellBorder inside = searchBand(frame, main, 0.6, kInside, look);
  CellBorder ooplasm = main;
  if (!outside.empty()) {
    layers.zona_outer = outside.back();
  } else if (isSecondBorder(inside) && inside.polarity == main.polarity && inside.strength > kClear * main.strength) {
    layers.zona_outer = main;
    ooplasm = inside;
  }
  if (!layers.zona_outer.finding.hasValues()) {
    layers.ooplasm = refined(frame, ooplasm, 0, 0);
    warn(layers);
    return layers;
  }
  const double gap = radiusOf(layers.zona_outer) - radiusOf(ooplasm);
  layers.ooplasm = refined(frame, ooplasm, kOoplasmPlace, std::min(kWidestRim * radiusOf(ooplasm), 0.8 * gap));
  layers.zona_outer = refined(frame, layers.zona_outer, kZonaPlace, 0.35 * gap);
  layers.main = ooplasm;
  layers.zona_inner = innerBorder(frame, layers, look);
  layers.main = main;
  warn(layers);
  return layers;
}

namespace {

CellBorder follow(const Frame& frame, const CellBorder& previous, const cv::Point2d& moved, double room, double place,
                  double rim) {
  if (!previous.finding.hasValues()) return {};
  CellBorder base = previous;
  base.ellipse.centre += moved;
  // The flank that is searched is at the outer end of the rim.
  const double radius = radiusOf(previous), flank = 1 + place * previous.rim / radius;
  base.ellipse = scaled(base.ellipse, flank);
  const PolarMap map(frame, base.ellipse, {-room, room, std::max(13, static_cast<int>(2 * room) + 1), kRays}, 2.0);
  const CellBorder found = findBorder(frame, map, previous.polarity, {}, scaleOf(frame, map), toleranceFor(radius));
  const bool faded = found.contrast < kFaded * previous.contrast;
  if (!found.finding.hasValues() || found.coverage < kLeastCoverage || faded) return {};
  CellBorder fine = refined(frame, found, place, rim);
  fine.strength = previous.strength;
  fine.contrast = previous.contrast;
  fine.consistency = found.consistency;
  return fine;
}

}  // namespace

CellLayers followLayers(const Frame& frame, const CellLayers& previous, double reach) {
  CellLayers layers;
  const bool zona = previous.zona_outer.finding.hasValues();
  const double gap = zona ? radiusOf(previous.zona_outer) - radiusOf(previous.ooplasm) : 0;
  const double place = zona ? kOoplasmPlace : 0;
  const double rim = zona ? std::min(kWidestRim * radiusOf(previous.ooplasm), 0.8 * gap) : 0;
  layers.ooplasm = follow(frame, previous.ooplasm, {0, 0}, reach + 4, place, rim);
  if (!layers.ooplasm.finding.hasValues()) return layers;
  layers.main = layers.ooplasm;
  // The clearest border tells how far the cell moved; the others are then near.
  const cv::Point2d moved = layers.ooplasm.ellipse.centre - previous.ooplasm.ellipse.centre;
  layers.zona_outer = follow(frame, previous.zona_outer, moved, 6, kZonaPlace, 0.35 * gap);
  if (zona) {
    // The zona keeps its thickness from frame to frame.
    layers.zona_inner = previous.zona_inner;
    layers.zona_inner.ellipse.centre += layers.zona_outer.ellipse.centre - previous.zona_outer.ellipse.centre;
  }
  warn(layers);
  return layers;
}

namespace {

/// Median grey value of each column over the rays within the image.
std::vector<double> medianGrey(const PolarMap& map) {
  std::vector<double> median(map.columns(), 0.0);
  for (int i = 0; i < map.columns(); ++i) {
    std::vector<float> values;
    for (int ray = 0; ray < map.rays(); ++ray) {
      if (map.valid().at<unsigned char>(ray, i) != 0) values.push_back(map.grey().at<float>(ray, i));
    }
    if (values.empty()) continue;
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    median[i] = values[values.size() / 2];
  }
  return median;
}

constexpr double kBubbleDepth = 0.5, kBlackDepth = 0.7;  // of the light outside, that the rim takes
constexpr double kBubbleRim = 0.11;                      // of the radius, a bubble's rim at half its depth

}  // namespace

bool isBubble(const Frame& frame, const CellLayers& layers) {
  const PolarMap map = mapAbout(frame, layers.main.ellipse, 0.1, 1.2);
  const std::vector<double> grey = medianGrey(map);
  const auto columnOf = [&](double ratio) { return static_cast<int>((ratio - 0.1) / 1.1 * (map.columns() - 1)); };
  const double outside = *std::max_element(grey.begin() + columnOf(1.02), grey.end());
  const auto darkest = std::min_element(grey.begin() + columnOf(0.4), grey.begin() + columnOf(1.0));
  const double middle = *std::max_element(grey.begin(), darkest + 1);
  const double depth = (outside - *darkest) / std::max(outside, 1e-6), half = 0.5 * (outside + *darkest);
  auto first = darkest, last = darkest;
  while (first != grey.begin() && *first < half) --first;
  while (last + 1 != grey.end() && *last < half) ++last;
  const double width = static_cast<double>(last - first) / columnOf(1.1);
  const bool bright = middle > *darkest + 0.6 * (outside - *darkest);
  const bool zona = layers.zona_outer.finding.hasValues();
  return bright && width > kBubbleRim && depth > (zona ? kBlackDepth : kBubbleDepth);
}

}  // namespace microinjection
