#include "vision/layers/bubble.h"

#include <algorithm>
#include <vector>

namespace microinjection {
namespace {

constexpr int kRimRays = 96, kRimColumns = 110;
constexpr double kRimSmoothing = 1.2;  // columns

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

constexpr double kBlackFrom = 0.75, kBlackTo = 0.9;  // of the radius, the ring that a bubble has black
constexpr double kBlack = 0.16;      // of the light beside it; the darkest oocytes, full of lipid, keep a fifth
constexpr double kBlackShare = 0.8;  // of the directions within the image
constexpr int kRingColumns = 8;

}  // namespace

bool isBlack(const Frame& frame, const Ellipse& border) {
  const double radius = 0.5 * border.meanDiameter();
  const PolarMap map(frame, border, {(kBlackFrom - 1) * radius, (kBlackTo - 1) * radius, kRingColumns, kRimRays}, 0);
  int seen = 0, black = 0;
  for (int ray = 0; ray < map.rays(); ++ray) {
    double sum = 0;
    bool valid = true;
    for (int i = 0; i < map.columns(); ++i) {
      valid = valid && map.valid().at<unsigned char>(ray, i) != 0;
      sum += map.grey().at<float>(ray, i);
    }
    seen += valid ? 1 : 0;
    black += valid && sum < kBlack * frame.background() * map.columns() ? 1 : 0;
  }
  return seen > kRimRays / 8 && black > kBlackShare * seen;
}

bool isBubble(const Frame& frame, const CellLayers& layers) {
  const Ellipse& main = layers.main.ellipse;
  const double radius = 0.5 * main.meanDiameter();
  const PolarMap map(frame, main, {-0.9 * radius, 0.2 * radius, kRimColumns, kRimRays}, kRimSmoothing);
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
