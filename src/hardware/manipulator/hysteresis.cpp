#include "hardware/manipulator/hysteresis.h"

#include <algorithm>

namespace microinjection {

HysteresisConfig HysteresisConfig::read(ConfigReader& reader) {
  HysteresisConfig config;
  reader.number("width", config.width, Range::nonNegative());
  reader.number("range", config.range, Range::positive());
  // The sum of the weights is width kStops / (range (kStops + 1)). From 1 on the output would move
  // against the input.
  if (!(config.width < config.range)) reader.error("width", "must be below range");
  return config;
}

Hysteresis::Hysteresis(const HysteresisConfig& config) : config_(config) {
  // In saturation the sum of weight times threshold is width / 2.
  weight_ = config.width / (config.range * (kStops + 1));
}

double Hysteresis::follow(double input) {
  const double moved = input - input_;
  input_ = input;
  double held = 0;
  for (int i = 0; i < kStops; ++i) {
    const double threshold = config_.range * (i + 1) / kStops;
    strains_[i] = std::clamp(strains_[i] + moved, -threshold, threshold);
    held += strains_[i];
  }
  return input - weight_ * held;
}

}  // namespace microinjection
