#include "operation/teleoperation/tremor_filter.h"

#include <cmath>

namespace microinjection {

TremorFilterConfig TremorFilterConfig::read(ConfigReader reader) {
  TremorFilterConfig config;
  reader.number("cutoff", config.cutoff, Range::closed(0, 100));
  return config;
}

TremorFilter::TremorFilter(const TremorFilterConfig& config) : frequency_(2 * M_PI * config.cutoff) {}

void TremorFilter::reset(const Eigen::Vector3d& position) {
  input_ = output_ = position;
  velocity_.setZero();
}

Eigen::Vector3d TremorFilter::step(const Eigen::Vector3d& position, double dt) {
  if (frequency_ == 0) return position;
  const double w2 = frequency_ * frequency_, c = std::sqrt(2.0) * frequency_, half = dt / 2;
  const Eigen::Vector3d before = w2 * (input_ - output_) - c * velocity_;
  const Eigen::Vector3d after = w2 * (position - output_ - half * velocity_);
  const Eigen::Vector3d velocity = (velocity_ + half * (before + after)) / (1 + half * c + half * half * w2);
  output_ += half * (velocity_ + velocity);
  velocity_ = velocity;
  input_ = position;
  return output_;
}

double TremorFilter::delay() const { return frequency_ > 0 ? std::sqrt(2.0) / frequency_ : 0; }

}  // namespace microinjection
