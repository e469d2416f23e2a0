#include "vision/pipette/tip_walls.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "vision/pipette/pipette_strip.h"

namespace microinjection {
namespace {

constexpr int kHalfStrip = 24, kBackground = 2;           // px from the axis; columns at each side that show no needle
constexpr int kNearRow = 3, kFarRow = 12, kTogether = 4;  // rows behind the end
constexpr int kProfile = 5, kProfileRows = 10;            // the same of the profile
constexpr int kWallColumns = 22, kProfileColumns = 20;    // px from the axis
constexpr double kStripBlur = 1;                          // px
constexpr double kSeenProfile = 0.15;                     // of the profile's largest value

/// Product of the derivatives at mirrored places: positive where a wall on one side has its image on the other.
double sharedBy(const PipetteStrip& strip, int first) {
  double sum = 0;
  for (int row = first; row < first + kTogether; ++row) {
    const float* d = strip.across().ptr<float>(row) + strip.half();
    for (int t = 1; t <= kWallColumns; ++t) sum -= d[t] * d[-t];
  }
  return std::max(0.0, sum);
}

/// Mean of some rows, less the background beside the needle; the middle value is on the axis.
std::vector<double> profileAcross(const PipetteStrip& strip) {
  std::vector<double> profile(2 * kHalfStrip + 1, 0.0);
  for (int row = kProfile; row < kProfile + kProfileRows; ++row) {
    const float* grey = strip.grey().ptr<float>(row);
    for (std::size_t i = 0; i < profile.size(); ++i) profile[i] += grey[i] / kProfileRows;
  }
  double background = 0;
  for (int i = 0; i < kBackground; ++i)
    background += 0.5 * (profile[i] + profile[profile.size() - 1 - i]) / kBackground;
  for (double& value : profile) value -= background;
  return profile;
}

double oddOverEven(const std::vector<double>& profile) {
  double odd = 0, even = 0;
  for (int t = 1; t <= kProfileColumns; ++t) {
    odd += std::pow(profile[kHalfStrip + t] - profile[kHalfStrip - t], 2);
    even += std::pow(profile[kHalfStrip + t] + profile[kHalfStrip - t], 2);
  }
  return std::sqrt(odd / std::max(even, 1e-12));
}

double halfWidthOf(const std::vector<double>& profile) {
  double most = 0;
  for (const double value : profile) most = std::max(most, std::abs(value));
  const auto seen = [&](double value) { return std::abs(value) > kSeenProfile * most; };
  const auto first = std::find_if(profile.begin(), profile.end(), seen);
  const auto last = std::find_if(profile.rbegin(), profile.rend(), seen).base();
  return 0.5 * static_cast<double>(std::max<std::ptrdiff_t>(last - first - 1, 0));
}

}  // namespace

TipWalls measureTipWalls(const Frame& frame, const cv::Point2d& end, double direction) {
  PipetteStrip::Shape shape;
  shape.direction = direction;
  shape.origin = end;
  shape.rows = kFarRow + kTogether + 1;
  shape.half = kHalfStrip;
  const PipetteStrip strip(frame, shape, kStripBlur, kStripBlur);
  TipWalls walls;
  const double far = sharedBy(strip, kFarRow);
  walls.kept = far > 0 ? sharedBy(strip, kNearRow) / far : 0;
  const std::vector<double> profile = profileAcross(strip);
  walls.shading = oddOverEven(profile);
  walls.half_width = halfWidthOf(profile);
  return walls;
}

}  // namespace microinjection
