#include "vision/border/border_search.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "vision/frame/polar_map.h"

namespace microinjection {
namespace {

constexpr double kNextBorder = 1.1, kNextStrength = 0.75;
constexpr double kSecondCoverage = 0.55, kSecondConsistency = 0.6, kSecondStrength = 0.55;  // of a second border
constexpr double kRingSignificance = 4, kRingCoverage = 0.45;                               // of a faint ring
constexpr double kFaintCoverage = 0.8;                                                      // of a border in noise
constexpr double kBesideRing = 8;      // px, to both sides of a faint ring
constexpr double kFaintSmoothing = 2;  // px
constexpr double kFreeGain = 0.07;     // of strength, what a freer path must be better by
constexpr double kSure = 0.9;          // strength that needs no freer path

std::vector<Polarity> polaritiesOf(ContrastMode mode) {
  if (mode == ContrastMode::kDic) return {Polarity::kEither};
  return {Polarity::kRising, Polarity::kFalling};
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

constexpr int kLeastRays = 8;                                         // inside of the image, of a sector
constexpr int kHalfLine = 1, kBackgroundFrom = 4, kBackgroundTo = 6;  // px, of a line and the background beside it
constexpr double kLeastSize = 0.015;                                  // of the format's range of grey values, of a line
constexpr double kLeastOfScatter = 7;                                 // the same, over what the profile has elsewhere
constexpr double kNormal = 1.4826;                                    // standard deviation over the median of the sizes

/// Grey value at each radius: the median of the sectors' means.
std::vector<double> radialProfile(const PolarMap& map) {
  std::vector<double> profile;
  for (int column = 0; column < map.columns(); ++column) {
    std::vector<double> means;
    for (int sector = 0; sector < kAveragedSectors; ++sector) {
      double sum = 0;
      int rays = 0;
      for (int ray = sector * kRaysOfAveragedSector; ray < (sector + 1) * kRaysOfAveragedSector; ++ray) {
        if (map.valid().at<unsigned char>(ray, column) == 0) continue;
        sum += map.grey().at<float>(ray, column);
        ++rays;
      }
      if (rays >= kLeastRays) means.push_back(sum / rays);
    }
    if (2 * means.size() <= kAveragedSectors) break;
    profile.push_back(upperMedian(means));
  }
  return profile;
}

double meanBetween(const std::vector<double>& values, int first, int last) {
  double sum = 0;
  for (int i = first; i <= last; ++i) sum += values[i];
  return sum / (last - first + 1);
}

}  // namespace

double radiusOf(const CellBorder& border) { return 0.5 * border.ellipse.meanDiameter(); }

double toleranceFor(double radius) { return std::max(1.0, 0.03 * radius); }

PolarMap mapAbout(const Frame& frame, const Ellipse& base, double low, double high) {
  const double radius = 0.5 * base.meanDiameter();
  return {frame, base, {(low - 1) * radius, (high - 1) * radius, kSearchColumns, kSearchRays}, kSearchSmoothing};
}

double scaleOf(const Frame& frame, const PolarMap& map) {
  return std::max(slopeScale(map, 0, map.columns()), 0.2 * frame.noise());
}

CellBorder bestBorder(const Frame& frame, const PolarMap& map, ContrastMode mode, double radius,
                      const BorderBand& band) {
  CellBorder best;
  const double scale = scaleOf(frame, map);
  for (const Polarity polarity : polaritiesOf(mode)) {
    const CellBorder border = findBorder(frame, map, polarity, band, scale, toleranceFor(radius));
    if (borderScore(border) > borderScore(best)) best = border;
  }
  return best;
}

bool isSecondBorder(const CellBorder& border) {
  return border.finding.hasValues() && border.coverage >= kSecondCoverage && border.consistency >= kSecondConsistency &&
         border.strength >= kSecondStrength && border.outside < 0.5;
}

CellBorder searchBand(const Frame& frame, const CellBorder& main, double low, double high, ContrastMode mode,
                      double outwards) {
  const double radius = 0.5 * main.ellipse.meanDiameter();
  const PolarMap map = mapAbout(frame, main.ellipse, low, high);
  const CellBorder border = bestBorder(frame, map, mode, radius, {{}, {}, outwards});
  if (border.strength > kSure) return border;
  // A border about another centre moves more from ray to ray; so does a path of noise.
  const CellBorder freer = bestBorder(frame, map, mode, radius, {{}, {}, outwards, kFreeChange});
  return freer.strength > border.strength + kFreeGain ? freer : border;
}

bool isRing(const CellBorder& border) {
  return border.finding.hasValues() && border.significance > kRingSignificance && border.coverage > kRingCoverage;
}

CellBorder faintBorder(const Frame& frame, const CellBorder& inner, double least, double limit, ContrastMode mode) {
  if (mode == ContrastMode::kDic) return {};
  const std::optional<double> ring = findFaintRing(frame, inner.ellipse, least, limit / radiusOf(inner));
  if (!ring) return {};
  const Ellipse base = scaled(inner.ellipse, *ring);
  const PolarMap map(frame, base, {-kBesideRing, kBesideRing, static_cast<int>(2 * kBesideRing) + 1, kSearchRays},
                     kFaintSmoothing);
  const double tolerance = toleranceFor(0.5 * base.meanDiameter());
  const CellBorder border = findBorder(frame, map, Polarity::kRising, {}, scaleOf(frame, map), tolerance);
  return isRing(border) && border.coverage > kFaintCoverage ? border : CellBorder();
}

std::vector<CellBorder> bordersOutside(const Frame& frame, const CellBorder& main, double limit, ContrastMode mode) {
  std::vector<CellBorder> found;
  double low = kBorderGap;
  while (low + 0.03 < limit && found.size() < 3) {
    CellBorder next = searchBand(frame, main, low, limit, mode, kOutwards);
    if (!isSecondBorder(next) || next.significance < kBorderSignificance) {
      // Near a zona's border that was found, a ring is its halo.
      const CellBorder& inner = found.empty() ? main : found.back();
      next = faintBorder(frame, inner, found.empty() ? kBorderGap : kNextBorder, limit * radiusOf(main), mode);
      if (next.finding.hasValues()) found.push_back(next);
      break;
    }
    // Near another border a halo of it may look like one.
    const bool near = radiusOf(next) < kNextBorder * radiusOf(found.empty() ? main : found.back());
    if (near && next.strength < kNextStrength) break;
    found.push_back(settled(frame, next, found.empty() ? radiusOf(main) : radiusOf(found.back())));
    low = radiusOf(next) / radiusOf(main) + 0.03;
  }
  return found;
}

std::optional<double> findFaintRing(const Frame& frame, const Ellipse& base, double low, double high) {
  const double radius = 0.5 * base.meanDiameter();
  const int columns = static_cast<int>((high - low) * radius);
  if (columns < 4 * kBackgroundTo) return std::nullopt;
  const PolarMap map(frame, base,
                     {(low - 1) * radius, (high - 1) * radius, columns, kAveragedSectors * kRaysOfAveragedSector}, 0);
  const std::vector<double> profile = radialProfile(map);
  std::vector<double> darkness, sizes;
  for (int i = kBackgroundTo; i + kBackgroundTo < static_cast<int>(profile.size()); ++i) {
    const double beside = 0.5 * (meanBetween(profile, i - kBackgroundTo, i - kBackgroundFrom) +
                                 meanBetween(profile, i + kBackgroundFrom, i + kBackgroundTo));
    darkness.push_back(beside - meanBetween(profile, i - kHalfLine, i + kHalfLine));
    sizes.push_back(std::abs(darkness.back()));
  }
  if (darkness.empty()) return std::nullopt;
  const auto darkest = std::max_element(darkness.begin(), darkness.end());
  if (*darkest < std::max(kLeastSize, kLeastOfScatter * kNormal * upperMedian(sizes))) return std::nullopt;
  return low + static_cast<double>(darkest - darkness.begin() + kBackgroundTo) * map.step() / radius;
}

}  // namespace microinjection
