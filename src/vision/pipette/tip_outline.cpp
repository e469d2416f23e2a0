#include "vision/pipette/tip_outline.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace microinjection {
namespace {

constexpr int kFirstRow = 5, kRows = 48, kEachRow = 3;  // behind the end
constexpr double kMostTipGrowth = 0.24, kTipGrowthStep = 0.02;
constexpr double kLeastHalfWidth = 1, kHalfWidthStep = 0.5;  // columns, of half widths that are tried
constexpr double kNearlyAsClear = 0.25;                      // of the clearest pair of lines

/// Size of the edge that both sides of a row have at each distance from the axis, over the largest of the row.
struct Row {
  double behind;  ///< rows behind the end
  std::vector<double> shared;
};

std::vector<Row> rowsOf(const PipetteStrip& strip, double end) {
  std::vector<Row> rows;
  const int first = static_cast<int>(std::lround(end)) + kFirstRow;
  for (int row = std::max(0, first); row < std::min(first + kRows, strip.rows()); row += kEachRow) {
    if (!strip.inside(row)) break;
    Row values{row - end, {}};
    const float* d = strip.across().ptr<float>(row) + strip.half();
    for (int t = 0; t <= strip.half(); ++t) values.shared.push_back(std::min(std::abs(d[t]), std::abs(d[-t])));
    const double largest = *std::max_element(values.shared.begin(), values.shared.end());
    if (!(largest > 0)) continue;
    for (double& value : values.shared) value /= largest;
    rows.push_back(std::move(values));
  }
  return rows;
}

/// Mean over the rows along a line; lines that leave the strip have fewer.
double clearness(const std::vector<Row>& rows, double half_width, double growth) {
  double sum = 0;
  for (const Row& row : rows) {
    const double place = half_width + growth * row.behind;
    const auto i = static_cast<std::size_t>(place);
    if (i + 1 >= row.shared.size()) continue;
    sum += row.shared[i] + (place - static_cast<double>(i)) * (row.shared[i + 1] - row.shared[i]);
  }
  return sum / static_cast<double>(rows.size());
}

}  // namespace

TipOutline measureOutline(const PipetteStrip& strip, double end, double most) {
  TipOutline outline;
  const std::vector<Row> rows = rowsOf(strip, end);
  if (rows.size() < 4) return outline;
  const int widths = static_cast<int>((std::min(most, strip.half() - 2.0) - kLeastHalfWidth) / kHalfWidthStep) + 1;
  std::vector<double> clear(std::max(0, widths), 0.0), growths(clear);
  for (int i = 0; i < widths; ++i) {
    for (double growth = 0; growth <= kMostTipGrowth; growth += kTipGrowthStep) {
      const double value = clearness(rows, kLeastHalfWidth + kHalfWidthStep * i, growth);
      if (value <= clear[i]) continue;
      clear[i] = value;
      growths[i] = growth;
    }
  }
  if (widths < 3) return outline;
  const double least = kNearlyAsClear * *std::max_element(clear.begin(), clear.end());
  int i = widths - 2;
  while (i > 0 && (clear[i] < least || clear[i] < clear[i - 1] || clear[i] < clear[i + 1])) --i;
  outline.valid = true;
  outline.half_width = kLeastHalfWidth + kHalfWidthStep * i;
  outline.growth = growths[i];
  return outline;
}

}  // namespace microinjection
