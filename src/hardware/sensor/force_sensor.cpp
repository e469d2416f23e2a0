#include "hardware/sensor/force_sensor.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace microinjection {
namespace {

void readAxes(ConfigReader& reader, const std::string& quantity, Eigen::Vector2d& value, const Range& range) {
  reader.number("axial_" + quantity, value[0], range);
  reader.number("lateral_" + quantity, value[1], range);
}

NoiseConfig noiseOf(const ForceSensorConfig& config, int axis) {
  return {config.density[axis], config.flicker_corner, config.random_walk[axis], config.drift_rate[axis]};
}

}  // namespace

ForceSensorConfig ForceSensorConfig::read(ConfigReader& reader) {
  ForceSensorConfig config;
  readAxes(reader, "range", config.range, Range::positive());
  readAxes(reader, "overload", config.overload, Range::positive());
  readAxes(reader, "noise_density", config.density, Range::nonNegative());
  readAxes(reader, "random_walk", config.random_walk, Range::nonNegative());
  readAxes(reader, "drift_rate", config.drift_rate, Range::finite());
  reader.number("natural_frequency", config.natural_frequency, Range::positive());
  reader.number("damping_ratio", config.damping_ratio, Range::positive());
  Eigen::Vector4d rows(1, 0.02, 0.02, 1);
  reader.vector("sensitivity", rows, Range::closed(-10, 10));
  config.sensitivity << rows[0], rows[1], rows[2], rows[3];
  reader.integer("bits", config.bits, Range::closed(4, 32));
  reader.number("sample_rate", config.sample_rate, Range::closed(1, 1e6));
  reader.number("flicker_corner", config.flicker_corner, Range::closed(0, config.sample_rate / 10));
  reader.integer("seed", config.seed, Range::closed(0, 2147483647));
  const char* const keys[] = {"axial_overload", "lateral_overload"};
  for (int axis = 0; axis < 2; ++axis) {
    if (config.overload[axis] < config.range[axis]) reader.error(keys[axis], "must not be below the axis' range");
  }
  return config;
}

bool ForceSensorConfig::mayRepeat(double rate) const {
  constexpr double kShown = 0.65;  ///< of the step
  const Eigen::Array2d noise = density.array() * std::sqrt(sample_rate / 2);
  const Eigen::Array2d step = 2 * range.array() / std::pow(2.0, bits);
  return (noise < kShown * step).all() || sample_rate < rate;
}

ForceSensor::ForceSensor(const ForceSensorConfig& config)
    : config_(config),
      normal_(static_cast<std::uint64_t>(config.seed)),
      noise_{Noise(noiseOf(config, 0), config.sample_rate, normal_),
             Noise(noiseOf(config, 1), config.sample_rate, normal_)},
      overload_(config.overload),
      to_sample_(1 / config.sample_rate) {}

void ForceSensor::respond(const Eigen::Vector2d& force, double dt) {
  if (dt <= 0) return;
  if (dt != transition_dt_) {
    const double omega = 2 * M_PI * config_.natural_frequency;
    Eigen::Matrix2d rate;
    rate << 0, 1, -omega * omega, -2 * config_.damping_ratio * omega;
    transition_ = Eigen::Matrix2d(rate * dt).exp();
    transition_dt_ = dt;
  }
  // Exact for a force that is constant over the step: the deviation from the new equilibrium
  // decays.
  Eigen::Matrix2d rest = Eigen::Matrix2d::Zero();
  rest.row(0) = force.transpose();
  state_ = rest + transition_ * (state_ - rest);
  overload_.check(state_.row(0).transpose());
}

Eigen::Vector2d ForceSensor::sample(const Eigen::Vector2d& force, double dt) {
  const double period = 1 / config_.sample_rate;
  // A sample that is due within the rounding error of dt belongs to this step. Otherwise steps of
  // one period would drift against the samples.
  const double rounding = 1e-6 * period;
  while (dt >= to_sample_ - rounding) {
    // Reuses the transition for a full period instead of computing an exponential for each sample.
    respond(force, std::abs(to_sample_ - period) < rounding ? period : to_sample_);
    convert();
    dt -= to_sample_;
    to_sample_ = period;
  }
  if (dt > rounding) respond(force, dt);
  to_sample_ -= dt;
  return reading_;
}

void ForceSensor::convert() {
  reading_ = config_.sensitivity * state_.row(0).transpose();
  saturated_ = false;
  for (int i = 0; i < 2; ++i) {
    const double range = config_.range[i];
    reading_[i] += noise_[i].sample(normal_);
    saturated_ = saturated_ || std::abs(reading_[i]) > range;
    const double step = 2 * range / std::pow(2.0, config_.bits);
    reading_[i] = std::clamp(std::round(reading_[i] / step) * step, -range, range);
  }
}

}  // namespace microinjection
