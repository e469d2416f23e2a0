#include "vision/border/faint_ring.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/median.h"
#include "vision/frame/polar_map.h"

namespace microinjection {
namespace {

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
