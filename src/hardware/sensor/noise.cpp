#include "hardware/sensor/noise.h"

#include <cmath>

namespace microinjection {
namespace {

constexpr double kLowestCorner = 1e-3;                  // Hz
constexpr double kCornerRatio = 3.1622776601683793320;  // two per decade: the ripple of the sum is below 2 %

}  // namespace

double StandardNormal::next() {
  const double unit = 1.0 / 9007199254740992.0;  // 2^-53
  const double u = (static_cast<double>(random_() >> 11) + 1) * unit;
  const double v = static_cast<double>(random_() >> 11) * unit;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
}

Noise::Noise(const NoiseConfig& config, double sample_rate, StandardNormal& normal)
    : config_(config), period_(1 / sample_rate), white_(config.density * std::sqrt(sample_rate / 2)) {
  if (config.flicker_corner <= 0 || config.density <= 0) return;
  const double deviation = config.density * std::sqrt(config.flicker_corner * std::log(kCornerRatio));
  for (double corner = kLowestCorner; corner < sample_rate / 2; corner *= kCornerRatio) {
    const double keep = std::exp(-2 * M_PI * corner * period_);
    flicker_.push_back({keep, deviation * std::sqrt(1 - keep * keep), deviation * normal.next()});
  }
}

double Noise::sample(StandardNormal& normal) {
  double value = white_ > 0 ? white_ * normal.next() : 0;
  for (LowPass& part : flicker_) {
    part.value = part.keep * part.value + part.spread * normal.next();
    value += part.value;
  }
  if (config_.random_walk > 0) walk_ += config_.random_walk * std::sqrt(period_) * normal.next();
  drift_ += config_.drift_rate * period_;
  return value + walk_ + drift_;
}

}  // namespace microinjection
