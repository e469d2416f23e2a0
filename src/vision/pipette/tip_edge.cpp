#include "vision/pipette/tip_edge.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kFringesPerTable = 0.2;
constexpr int kTables = 15;          // of fringes 0 to kMostFringes
constexpr double kTableStep = 0.05;  // of |s| / sqrt|variance|
constexpr double kNegligible = 7.6;  // the kernel has fallen to exp(-7.6) at the end of a table
constexpr int kSubsteps = 4;

using Table = std::vector<std::complex<float>>;

/// Integral of the kernel from 0 outwards; it ends at 1/2.
Table tableOf(double fringes) {
  const double argument = std::atan(fringes);
  const std::complex<double> variance = std::polar(1.0, argument);
  const auto kernel = [&](double v) { return std::exp(-v * v / (2.0 * variance)) / std::sqrt(2 * M_PI * variance); };
  const int steps = static_cast<int>(std::sqrt(2 * kNegligible / std::cos(argument)) / kTableStep) + 1;
  Table table(1, 0);
  std::complex<double> sum = 0;
  const double h = kTableStep / kSubsteps;
  for (int i = 0; i < steps * kSubsteps; ++i) {
    sum += h * kernel((i + 0.5) * h);
    if (i % kSubsteps == kSubsteps - 1) table.emplace_back(sum);
  }
  table.emplace_back(0.5F, 0);
  return table;
}

const Table& tableFor(double fringes) {
  static const std::array<Table, kTables> tables = [] {
    std::array<Table, kTables> all;
    for (int i = 0; i < kTables; ++i) all[i] = tableOf(i * kFringesPerTable);
    return all;
  }();
  return tables[std::clamp(static_cast<int>(std::lround(fringes / kFringesPerTable)), 0, kTables - 1)];
}

}  // namespace

TipEdge::TipEdge(double blur, double fringes)
    : table_(&tableFor(fringes)), to_table_(1 / (kTableStep * blur * std::pow(1 + fringes * fringes, 0.25))) {}

std::complex<float> TipEdge::at(double s) const {
  const auto& table = *table_;
  const double v = std::abs(s) * to_table_;
  const auto i = static_cast<std::size_t>(v);
  if (i + 1 >= table.size()) return {s > 0 ? 1.0F : 0.0F, 0};
  const std::complex<float> rise =
      table[i] + static_cast<float>(v - static_cast<double>(i)) * (table[i + 1] - table[i]);
  return s >= 0 ? 0.5F + rise : 0.5F - rise;
}

}  // namespace microinjection
