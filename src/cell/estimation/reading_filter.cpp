#include "cell/estimation/reading_filter.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kFarOff = 6;    // of a reading from its neighbours, over the noise
constexpr double kMany = 0.3;    // share of outliers among the newest readings
constexpr double kShare = 0.02;  // of the newest reading in that share

template <std::size_t size>
double median(std::array<double, size>& values, std::size_t count) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

}  // namespace

ReadingFilter::Verdict ReadingFilter::judge(double time, double force, double noise) {
  window_[received_++ % kWindow] = {time, force};
  if (repetition_.step(force, 1)) return Verdict::kFrozen;
  if (received_ < kWindow) return Verdict::kUnknown;
  const bool outlier = isOutlier(noise);
  outliers_ += kShare * ((outlier ? 1 : 0) - outliers_);
  return outlier ? Verdict::kOutlier : Verdict::kGood;
}

/// Hampel's filter about the line of Theil and Sen: the window's median slope, and the median about it.
bool ReadingFilter::isOutlier(double noise) const {
  const Reading& newest = window_[(received_ - 1) % kWindow];
  std::array<double, kWindow*(kWindow - 1) / 2> slopes{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < kWindow; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double passed = window_[i].time - window_[j].time;
      if (passed != 0) slopes[count++] = (window_[i].force - window_[j].force) / passed;
    }
  }
  const double slope = count > 0 ? median(slopes, count) : 0;
  std::array<double, kWindow> level{};
  for (std::size_t i = 0; i < kWindow; ++i) {
    level[i] = window_[i].force - slope * (window_[i].time - newest.time);
  }
  return !(std::abs(newest.force - median(level, kWindow)) <= kFarOff * noise);
}

std::string ReadingFilter::complaint() const {
  if (repetition_.repeats()) return "the force sensor repeats the same reading";
  if (outliers_ > kMany) return "the readings of the force sensor jump";
  return "";
}

}  // namespace microinjection
