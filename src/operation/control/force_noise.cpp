#include "operation/control/force_noise.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

void ForceNoise::add(double force) {
  if (ready()) return;
  ++count_;
  const double change = force - mean_;
  mean_ += change / count_;
  squares_ += change * (force - mean_);
}

double ForceNoise::deviation() const {
  if (count_ < 2) return floor_;
  const double standard_error = 1 / std::sqrt(2.0 * (count_ - 1));  // of a deviation, relative
  return std::max(floor_, std::sqrt(squares_ / (count_ - 1)) * (1 + 2 * standard_error));
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
