#include "vision/calibration/tip_history.h"

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include "vision/calibration/statistics.h"

namespace microinjection {
namespace {

constexpr std::size_t kLeastTips = 4;        ///< below, the spread says nothing
constexpr double kLeastSpread = 10e-6;       ///< m, what one holder and equal pipettes leave
constexpr double kRegionConfidence = 0.995;  ///< two-sided, of each coordinate

}  // namespace

bool TipRegion::contains(const Eigen::Vector2d& place) const {
  return (place.array() >= low.array()).all() && (place.array() <= high.array()).all();
}

std::optional<TipRegion> tipRegion(const std::vector<TipRecord>& history) {
  if (history.size() < kLeastTips) return std::nullopt;
  TipRegion region;
  region.count = static_cast<int>(history.size());
  const double n = region.count;
  const double reach = studentLimit(kRegionConfidence, n - 1) * std::sqrt(1 + 1 / n);
  for (int i = 0; i < 2; ++i) {
    std::vector<double> values;
    for (const TipRecord& tip : history) values.push_back(tip.place[i]);
    region.median[i] = medianOf(values);
    region.spread[i] = std::max(kLeastSpread, robustDeviation(values));
  }
  region.low = region.median - reach * region.spread;
  region.high = region.median + reach * region.spread;
  return region;
}

std::string tipWarning(const TipRecord& tip, const std::vector<TipRecord>& history) {
  const std::optional<TipRegion> region = tipRegion(history);
  if (!region || region->contains(tip.place)) return "";
  std::ostringstream text;
  text.precision(4);
  for (int i = 0; i < 2; ++i) {
    if (tip.place[i] >= region->low[i] && tip.place[i] <= region->high[i]) continue;
    text << (text.tellp() > 0 ? "; " : "") << "tip " << (i == 0 ? "x" : "z") << " = " << 1e6 * tip.place[i]
         << " um: expected in [" << 1e6 * region->low[i] << ", " << 1e6 * region->high[i] << "] um, from "
         << region->count << " tips of this holder (median " << 1e6 * region->median[i] << " um, spread "
         << 1e6 * region->spread[i] << " um)";
  }
  return text.str();
}

bool isDate(const std::string& text) {
  static const std::regex kForm(R"(\d{4}-(0[1-9]|1[0-2])-(0[1-9]|[12]\d|3[01])T([01]\d|2[0-3]):[0-5]\d:([0-5]\d|60)Z)");
  return std::regex_match(text, kForm);
}

}  // namespace microinjection
