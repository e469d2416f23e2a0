#include "operation/control/contact_detector.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr double kSmallestAllowance = 0.15;  ///< also for the error of an offset that follows the drift
constexpr double kOffsetErrors = 2.6;        ///< standard errors of the offset at rest

constexpr int kDelay = 128;             ///< samples, see ContactDetector
constexpr double kFollow = 1e-3;        ///< weight of a sample in the offset
constexpr double kOffsetRange = 4;      ///< contact forces
constexpr double kSoftest = 5e-3;       ///< N/m, of the softest cell
constexpr double kRestAdvance = 1e-12;  ///< m a sample, below which the needle rests

double samplesBetweenFalseAlarms(double k, double h) {
  const double exponent = 2 * k * (h + 1.166);
  return (std::exp(exponent) - exponent - 1) / (2 * k * k);
}

/// An allowance below the offset's uncertainty would let the sum grow without bound.
double smallestAllowance(int samples) { return std::max(kSmallestAllowance, kOffsetErrors / std::sqrt(samples)); }

}  // namespace

double pageLimit(double k, double false_rate) {
  double low = 0, high = 1;
  while (samplesBetweenFalseAlarms(k, high) < 1 / false_rate) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (samplesBetweenFalseAlarms(k, middle) < 1 / false_rate ? low : high) = middle;
  }
  // The formula holds for small k. For a large k a single sample beyond k + h raises the alarm.
  return std::max(high, normalQuantile(false_rate) - k);
}

ContactDetector::ContactDetector(const ForceNoise& noise, double force, double false_rate)
    : offset_(noise.offset()),
      deviation_(noise.deviation()),
      allowance_(std::max(smallestAllowance(noise.samples()), 0.5 * force / noise.deviation())),
      limit_(pageLimit(allowance_, false_rate)),
      recent_(kDelay) {
  start_offset_ = offset_;
  offset_range_ = kOffsetRange * force;
  // An offset that follows a steady ramp lags by 1 / kFollow + kDelay samples.
  creep_limit_ = allowance_ * deviation_ / (1 / kFollow + kDelay) / kSoftest;
}

bool ContactDetector::isCreeping() const { return advance_ > kRestAdvance && advance_ < creep_limit_; }

bool ContactDetector::step(double force, double advance) {
  advance_ += (advance - advance_) / kDelay;
  double& oldest = recent_[static_cast<std::size_t>(count_ % kDelay)];
  if (count_++ >= kDelay && !isCreeping()) {
    offset_ = std::clamp(offset_ + kFollow * (oldest - offset_), start_offset_ - offset_range_,
                         start_offset_ + offset_range_);
  }
  oldest = force;
  sum_ = std::max(0.0, sum_ + (force - offset_) / deviation_ - allowance_);
  return sum_ > limit_;
}

}  // namespace microinjection
