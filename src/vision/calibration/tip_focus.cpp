#include "vision/calibration/tip_focus.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "vision/calibration/bell_fit.h"

namespace microinjection {
namespace {

constexpr int kLeastPlanes = 7;  ///< that a fit needs
constexpr int kMostApart = 8;    ///< planes, of the peaks of a transparent tip

std::string refusalOf(const std::vector<FocusSample>& samples) {
  if (samples.size() < kLeastPlanes) {
    return "planes = " + std::to_string(samples.size()) + ": must be at least " + std::to_string(kLeastPlanes);
  }
  for (const FocusSample& each : samples) {
    if (!std::isfinite(each.height) || !std::isfinite(each.sharpness)) return "a height or a sharpness is not finite";
  }
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].height <= samples[i - 1].height) return "two planes have the same height";
  }
  return "";
}

/// Index of the sharpest plane, by the median of three, so that one bad plane is not taken for it.
int sharpest(const std::vector<FocusSample>& samples) {
  const auto smooth = [&](std::size_t i) {
    const std::size_t low = i == 0 ? 0 : i - 1, high = std::min(i + 1, samples.size() - 1);
    return medianOf({samples[low].sharpness, samples[i].sharpness, samples[high].sharpness});
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (smooth(i) > smooth(best)) best = i;
  }
  return static_cast<int>(best);
}

/// Planes in order of height, and what is read off them.
struct Stack {
  explicit Stack(const std::vector<FocusSample>& planes) : samples(planes), best(sharpest(planes)) {
    foot = samples[0].sharpness;
    for (const FocusSample& each : samples) foot = std::min(foot, each.sharpness);
    range = samples[best].sharpness - foot;
    step = (samples.back().height - samples.front().height) / static_cast<double>(samples.size() - 1);
  }

  const std::vector<FocusSample>& samples;
  int best;            ///< index of the sharpest plane
  double foot, range;  ///< least sharpness, and that of the sharpest plane above it
  double step;         ///< m, between planes
};

/// The planes to fit. Their number stays the same at a border, where they reach further inwards.
std::vector<BellPoint> pointsBeside(const Stack& stack, const TipFocusConfig& config) {
  const int count = static_cast<int>(stack.samples.size());
  const int width = std::min(count, std::max(kLeastPlanes, 2 * config.planes_beside + 1));
  const int first = std::clamp(stack.best - width / 2, 0, count - width);
  std::vector<BellPoint> points;
  for (int i = first; i < first + width; ++i) {
    const FocusSample& each = stack.samples[i];
    const double height = (each.height - stack.samples[stack.best].height) / stack.step;
    points.push_back({height, (each.sharpness - stack.foot) / stack.range});
  }
  return points;
}

/// Index of a peak beside the main one that is nearly as high; -1 without one. A valley below half of the peak
/// must lie between them.
int secondPeak(const std::vector<FocusSample>& samples, int best, double foot, double share) {
  const double peak = samples[best].sharpness - foot;
  for (const int step : {-1, 1}) {
    bool valley = false;
    for (int i = best + step; i >= 0 && i < static_cast<int>(samples.size()); i += step) {
      const double value = samples[i].sharpness - foot;
      valley = valley || value < 0.5 * peak;
      if (valley && value > share * peak) return i;
    }
  }
  return -1;
}

/// Height of the valley between two peaks near each other; NaN without one. A transparent tip has such a
/// pair: its contrast vanishes in focus and is reversed beyond it. A single bad plane is not a peak.
double valleyBetween(const Stack& stack, const TipFocusConfig& config) {
  constexpr double kSupported = 0.5;  // of a peak, that one of the planes beside it has
  constexpr double kValley = 0.8;     // of the lower peak, that a valley has at most
  const int last = static_cast<int>(stack.samples.size()) - 1;
  const auto above = [&](int i) { return stack.samples[i].sharpness - stack.foot; };
  const auto isPeak = [&](int i) {
    return i > 0 && i < last && above(i) >= above(i - 1) && above(i) >= above(i + 1) &&
           std::max(above(i - 1), above(i + 1)) > kSupported * above(i);
  };
  // The sharpest of three is beside the peak when the planes on one side are sharper.
  int best = stack.best;
  for (const int i : {stack.best - 1, stack.best + 1}) {
    if (i >= 0 && i <= last && above(i) > above(best)) best = i;
  }
  if (!isPeak(best)) return std::nan("");
  for (int other = std::max(0, best - kMostApart); other <= std::min(last, best + kMostApart); ++other) {
    if (std::abs(other - best) < 3 || !isPeak(other) || above(other) < config.second_peak * above(best)) continue;
    int low = std::min(other, best) + 1;
    for (int i = low; i < std::max(other, best); ++i) {
      if (above(i) < above(low)) low = i;
    }
    if (above(low) > kValley * std::min(above(other), above(best))) continue;
    const double a = above(low - 1), b = above(low), c = above(low + 1);
    return stack.samples[low].height + stack.step * 0.5 * (a - c) / std::max(a - 2 * b + c, 1e-12);
  }
  return std::nan("");
}

/// Judges what was fitted; empty when it is a focus.
std::string doubtsOf(const Stack& stack, const FocusReport& report, const TipFocusConfig& config) {
  std::ostringstream text;
  const std::vector<FocusSample>& samples = stack.samples;
  const int other = secondPeak(samples, stack.best, stack.foot, config.second_peak);
  if (other >= 0) {
    text << "two peaks: at " << 1e6 * samples[stack.best].height << " um and at " << 1e6 * samples[other].height
         << " um";
  } else if (!(report.interval.half() <= config.largest_interval)) {
    text << "the height is vague: +- " << 1e6 * report.interval.half() << " um, allowed "
         << 1e6 * config.largest_interval << " um";
  }
  return text.str();
}

FocusReport borderReport(const std::vector<FocusSample>& samples, double height, int towards) {
  FocusReport report;
  report.verdict = FocusVerdict::kBorder;
  report.height = height;
  report.interval = {height, height};
  report.towards = towards;
  std::ostringstream text;
  text << "the peak is at the border of the planes, at " << 1e6 * height << " um of [" << 1e6 * samples.front().height
       << ", " << 1e6 * samples.back().height << "] um: add planes " << (towards > 0 ? "above" : "below");
  report.text = text.str();
  return report;
}

}  // namespace

TipFocusConfig TipFocusConfig::read(ConfigReader& reader) {
  TipFocusConfig config;
  reader.integer("planes_beside", config.planes_beside, Range::closed(3, 100));
  reader.number("least_contrast", config.least_contrast, Range::open(0, 1));
  reader.number("false_rate", config.false_rate, Range::open(0, 0.1));
  reader.number("largest_interval", config.largest_interval, Range::positive());
  reader.number("second_peak", config.second_peak, Range{0.5, 1, false, false});
  return config;
}

FocusReport findFocus(std::vector<FocusSample> samples, const TipFocusConfig& config) {
  std::sort(samples.begin(), samples.end(), [](const auto& a, const auto& b) { return a.height < b.height; });
  FocusReport report;
  report.text = refusalOf(samples);
  if (!report.text.empty()) return report;
  const Stack stack(samples);
  report.verdict = FocusVerdict::kNoPeak;
  report.text = "no peak: the planes do not differ";
  if (!(stack.range > config.least_contrast * std::abs(samples[stack.best].sharpness))) return report;
  const double valley = valleyBetween(stack, config);
  if (std::isfinite(valley)) {
    report.verdict = FocusVerdict::kUnsure;
    report.height = valley;
    report.interval = {valley - stack.step, valley + stack.step};
    std::ostringstream text;
    text << "two peaks, as a transparent tip has them: its focus is between them, at " << 1e6 * valley << " um";
    report.text = text.str();
    return report;
  }
  std::vector<BellPoint> points = pointsBeside(stack, config);
  const BellFit result = fitBell(points, 0.5 * config.planes_beside);
  if (result.good && !bellIsNeeded(points, result, config.false_rate)) return report;
  const double middle = samples[stack.best].height + stack.step * result.bell[2];
  const int last = static_cast<int>(samples.size()) - 1;
  const bool inside = middle > samples.front().height + stack.step && middle < samples.back().height - stack.step;
  if (stack.best < 2 || stack.best > last - 2 || (result.good && !inside)) {
    return borderReport(samples, samples[stack.best].height, 2 * stack.best < last ? -1 : 1);
  }
  report.verdict = FocusVerdict::kUnsure;
  report.text = "no bell fits the planes beside the sharpest";
  if (!result.good) return report;
  const double half = studentLimit(kIntervalConfidence, result.freedom()) * stack.step * result.deviation;
  report.height = middle;
  report.interval = {middle - half, middle + half};
  report.text = doubtsOf(stack, report, config);
  if (!report.text.empty()) return report;
  report.verdict = FocusVerdict::kFocus;
  std::ostringstream text;
  text << "best focus at " << 1e6 * middle << " +- " << 1e6 * half << " um";
  report.text = text.str();
  return report;
}

}  // namespace microinjection
