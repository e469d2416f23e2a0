// Cells, pipettes, dimples and focus: errors on rendered images with exact truth, and on real micrographs.

#include <algorithm>
#include <boost/program_options.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "benchmark/bench_main.h"
#include "benchmark/common/vision_cases.h"

namespace microinjection {
namespace {

int images = 40;
std::uint64_t first_seed = 100001;
std::string only;
bool pipettes_only = false;

double quantileOf(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

/// A number, or nothing for one that there is not.
std::string cell(double value, const char* pattern) {
  if (!std::isfinite(value)) return "";
  char text[40];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

std::string rowOf(const VisionRow& row) {
  std::string verdict = row.verdict;
  return row.set + ',' + row.image + ',' + row.what + ',' + cell(row.error, "%.4f") + ',' + cell(row.relative, "%.6f") +
         ',' + (row.found ? "1" : "0") + ',' + verdict + ',' + cell(1e3 * row.time, "%.3f") + '\n';
}

/// Errors are those of what was found without a warning.
struct Summary {
  std::vector<double> errors, times;
  int count = 0, found = 0, sure = 0, wrong = 0;
};

double rmsOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

void printSummary(const std::map<std::pair<std::string, std::string>, Summary>& all) {
  std::printf("\n%-26s %-18s %6s %7s %7s %7s %8s %10s %8s %8s\n", "set", "what", "images", "found", "sure", "wrong",
              "median", "nine_of_10", "rms", "time_ms");
  for (const auto& [key, summary] : all) {
    const double share = 100.0 / summary.count;
    std::printf("%-26s %-18s %6d %6.1f%% %6.1f%% %6.2f%% %8s %10s %8s %8s\n", key.first.c_str(), key.second.c_str(),
                summary.count, share * summary.found, share * summary.sure, share * summary.wrong,
                cell(quantileOf(summary.errors, 0.5), "%.3f").c_str(),
                cell(quantileOf(summary.errors, 0.9), "%.3f").c_str(), cell(rmsOf(summary.errors), "%.3f").c_str(),
                cell(1e3 * quantileOf(summary.times, 0.5), "%.2f").c_str());
  }
  std::printf(
      "median, nine_of_10 and rms (px; axis and polar body: degrees) are those of what is sure: found without a "
      "warning.\n"
      "wrong: sure, and off by more than %g times what is asked for, or where there is nothing\n",
      kWrongFactor);
}

std::string table() {
  std::string rows = "set,image,what,error_px,error_relative,found,verdict,time_ms\n";
  std::fputs(rows.c_str(), stdout);
  std::map<std::pair<std::string, std::string>, Summary> all;
  const auto take = [&](const VisionRow& row) {
    const std::string text = rowOf(row);
    std::fputs(text.c_str(), stdout);
    rows += text;
    Summary& summary = all[{row.set, row.what}];
    ++summary.count;
    summary.found += row.found ? 1 : 0;
    summary.wrong += row.wrong ? 1 : 0;
    summary.sure += row.sure ? 1 : 0;
    if (row.sure && std::isfinite(row.error)) summary.errors.push_back(row.error);
    if (std::isfinite(row.time)) summary.times.push_back(row.time);
  };
  for (const VisionCondition& condition : visionConditions()) {
    if (only.empty() || condition.name == only) renderedRows(condition, first_seed, images, pipettes_only, take);
  }
  if (only.empty() || only == "real") realRows(take);
  printSummary(all);
  return rows;
}

}  // namespace
}  // namespace microinjection

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  po::options_description more;
  more.add_options()("images", po::value(&microinjection::images)->default_value(40),
                     "rendered images of each condition")("only", po::value(&microinjection::only),
                                                          "one set: the name of a condition as in the table, or real")(
      "seed", po::value(&microinjection::first_seed)->default_value(100001),
      "of the first image; constants are chosen with seeds below 100000")(
      "pipettes", po::bool_switch(&microinjection::pipettes_only), "rendered images: measures the pipettes only");
  return microinjection::benchMain(argc, argv,
                                   "bench_vision: errors of the vision on rendered images, and on real ones where "
                                   "MICROINJECTION_MICROGRAPHS names their folder.",
                                   microinjection::table, more);
}
