#include "vision/layers/lines_outside.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "vision/frame/polar_map.h"

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

}  // namespace

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

}  // namespace microinjection
