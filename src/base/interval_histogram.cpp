#include "base/interval_histogram.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

void IntervalHistogram::add(double duration) {
  const double bin = std::log(std::max(duration, kSmallest) / kSmallest) / kWidth;
  ++bins_[std::min(bins_.size() - 1, static_cast<std::size_t>(bin))];
  ++count_;
  if (duration > limit_) ++over_limit_;
  largest_ = std::max(largest_, duration);
}

double IntervalHistogram::quantile(double quantile) const {
  if (count_ == 0) return 0;
  const double wanted = quantile * static_cast<double>(count_);
  double below = 0;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    below += bins_[i];
    if (below >= wanted && bins_[i] > 0) return std::min(largest_, kSmallest * std::exp((i + 0.5) * kWidth));
  }
  return largest_;
}

std::vector<IntervalHistogram::Bin> IntervalHistogram::bins() const {
  std::vector<Bin> result;
  for (std::size_t i = 0; i < bins_.size(); ++i) {
    const double upper = kSmallest * std::exp((static_cast<double>(i) + 1) * kWidth);
    if (bins_[i] > 0) result.push_back({upper, bins_[i]});
  }
  return result;
}

}  // namespace microinjection
