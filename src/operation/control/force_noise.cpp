#include "operation/control/force_noise.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

constexpr std::size_t kFewest = 20;  ///< samples, which give the force that a rise starts from
constexpr double kAlarm = 4;         ///< allowances of the cumulative sum

}  // namespace

ForceNoise::ForceNoise(int samples, double floor, double change)
    : wanted_(static_cast<std::size_t>(samples)), floor_(floor), change_(change) {
  samples_.reserve(wanted_);  // the samples come at the loop's rate
}

void ForceNoise::count(double force) {
  ++counted_;
  const double change = force - mean_;
  mean_ += change / counted_;
  squares_ += change * (force - mean_);
}

bool ForceNoise::rises(double force) {
  if (samples_.size() < kFewest) return false;
  if (samples_.size() == kFewest) start_ = mean_;
  const double allowance = std::max(0.5 * change_, deviation());
  rise_ = std::max(0.0, rise_ + force - start_ - allowance);
  if (rise_ == 0) onset_ = samples_.size() + 1;
  return rise_ > kAlarm * allowance;
}

void ForceNoise::add(double force) {
  if (ready_) return;
  if (rises(force)) {
    samples_.resize(std::max(kFewest, onset_));
    mean_ = squares_ = 0;
    counted_ = 0;
    for (const double sample : samples_) count(sample);
    ready_ = true;
    return;
  }
  samples_.push_back(force);
  count(force);
  ready_ = samples_.size() >= wanted_;
}

double ForceNoise::deviation() const {
  if (counted_ < 2) return floor_;
  const double standard_error = 1 / std::sqrt(2.0 * (counted_ - 1));  // of a deviation, relative
  return std::max(floor_, std::sqrt(squares_ / (counted_ - 1)) * (1 + 2 * standard_error));
}

double normalQuantile(double probability) {
  double low = 0, high = 40;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::sqrt(2.0)) > probability ? low : high) = middle;
  }
  return low;
}

}  // namespace microinjection
