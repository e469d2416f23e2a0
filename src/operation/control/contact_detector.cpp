#include "operation/control/contact_detector.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

/// Less than what the offset is uncertain by adds up without end.
constexpr double kSmallestAllowance = 0.15;

constexpr int kLate = 128;         ///< samples
constexpr double kFollow = 1e-3;   ///< share of a sample in the offset
constexpr double kFarthest = 4;    ///< contact forces
constexpr double kSoftest = 5e-3;  ///< N/m, of a cell
constexpr double kRests = 1e-12;   ///< m a sample

double samplesBetweenFalseAlarms(double k, double h) {
  const double exponent = 2 * k * (h + 1.166);
  return (std::exp(exponent) - exponent - 1) / (2 * k * k);
}

double limitFor(double k, double false_rate) {
  double low = 0, high = 1;
  while (samplesBetweenFalseAlarms(k, high) < 1 / false_rate) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (samplesBetweenFalseAlarms(k, middle) < 1 / false_rate ? low : high) = middle;
  }
  // The formula is for small k: for a large one a single sample beyond k + h is what alarms.
  return std::max(high, normalQuantile(false_rate) - k);
}

}  // namespace

ContactDetector::ContactDetector(const ForceNoise& noise, double force, double false_rate)
    : offset_(noise.offset()),
      deviation_(noise.deviation()),
      allowance_(std::max(kSmallestAllowance, 0.5 * force / noise.deviation())),
      limit_(limitFor(allowance_, false_rate)),
      late_(kLate) {
  rest_ = offset_;
  farthest_ = kFarthest * force;
  // An offset that follows a steady ramp stays behind by 1 / kFollow + kLate samples of it.
  creep_ = allowance_ * deviation_ / (1 / kFollow + kLate) / kSoftest;
}

bool ContactDetector::isCreeping() const { return advance_ > kRests && advance_ < creep_; }

bool ContactDetector::step(double force, double advance) {
  advance_ += (advance - advance_) / kLate;
  double& oldest = late_[static_cast<std::size_t>(count_ % kLate)];
  if (count_++ >= kLate && !isCreeping()) {
    offset_ = std::clamp(offset_ + kFollow * (oldest - offset_), rest_ - farthest_, rest_ + farthest_);
  }
  oldest = force;
  sum_ = std::max(0.0, sum_ + (force - offset_) / deviation_ - allowance_);
  return sum_ > limit_;
}

}  // namespace microinjection
