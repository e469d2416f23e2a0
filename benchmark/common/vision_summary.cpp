#include "benchmark/common/vision_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace microinjection {
namespace {

constexpr const char* kTotal = "TOTAL ";

double quantileOf(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

double rmsOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// In %, or nothing of nothing.
std::string shareText(int part, int whole, const char* pattern) {
  return numberText(whole > 0 ? 100.0 * part / whole : std::nan(""), pattern);
}

}  // namespace

std::string numberText(double value, const char* pattern) {
  if (!std::isfinite(value)) return "";
  char text[40];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

void VisionSummary::Count::add(const VisionRow& row) {
  if (std::isfinite(row.time)) times.push_back(row.time);
  if (row.verdict.empty()) return;
  ++images;
  found += row.found ? 1 : 0;
  sure += row.sure ? 1 : 0;
  wrong += row.wrong ? 1 : 0;
  limited += row.right ? 1 : 0;
  right += row.right.value_or(false) ? 1 : 0;
  if (!row.sure) return;
  if (std::isfinite(row.error)) errors.push_back(row.error);
  stated += row.covered ? 1 : 0;
  covered += row.covered.value_or(false) ? 1 : 0;
}

void VisionSummary::add(const VisionRow& row) {
  counts_[{row.set, row.what}].add(row);
  if (row.group.empty()) return;
  VisionRow total = row;  // whose errors, of different things, have no common quantile
  total.time = std::nan("");
  const std::string setup = row.set.substr(0, row.set.find('/')), all = kTotal + setup;
  counts_[{all, row.what}].add(total);
  total.error = std::nan("");
  counts_[{row.set, kTotal + row.group}].add(total);
  counts_[{all, kTotal + row.group}].add(total);
}

void VisionSummary::printLine(const std::string& set, const std::string& what, const Count& count) {
  std::printf(
      "%-26s %-22s %6s %7s %7s %7s %9s %6s %7s %8s %10s %8s %8s\n", set.c_str(), what.c_str(),
      count.images > 0 ? std::to_string(count.images).c_str() : "",
      shareText(count.sure, count.images, "%.1f%%").c_str(), shareText(count.right, count.limited, "%.1f%%").c_str(),
      shareText(count.wrong, count.images, "%.2f%%").c_str(),
      shareText(count.found - count.sure, count.images, "%.1f%%").c_str(),
      shareText(count.images - count.found, count.images, "%.1f%%").c_str(),
      shareText(count.covered, count.stated, "%.1f%%").c_str(),
      numberText(quantileOf(count.errors, 0.5), "%.3f").c_str(),
      numberText(quantileOf(count.errors, 0.9), "%.3f").c_str(), numberText(rmsOf(count.errors), "%.3f").c_str(),
      numberText(1e3 * quantileOf(count.times, 0.5), "%.2f").c_str());
}

void VisionSummary::print() const {
  std::printf("\n%-26s %-22s %6s %7s %7s %7s %9s %6s %7s %8s %10s %8s %8s\n", "set", "what", "images", "sure", "right",
              "wrong", "uncertain", "no", "covered", "median", "nine_of_10", "rms", "time_ms");
  for (const auto& [key, count] : counts_) printLine(key.first, key.second, count);
  std::printf(
      "sure: found without a warning. median, nine_of_10 and rms (px; axis and polar body: degrees) are those of what "
      "is "
      "sure.\n"
      "covered: share of what is sure whose truth is in the stated interval of 95 %%, with the reading's tolerance.\n"
      "right, wrong: sure, and within the limit or not; in rendered images wrong is off by more than %g times what is "
      "asked for. Sure where there is nothing is wrong.\n",
      kWrongFactor);
}

}  // namespace microinjection
