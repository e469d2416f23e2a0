#include "sensor/force_sensor.h"

#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace microinjection {
namespace {

/// Standard normal deviate by Box and Muller: unlike std::normal_distribution it is the same in every library.
double standardNormal(std::mt19937_64& random) {
  const double unit = 1.0 / 9007199254740992.0;  // 2^-53
  const double u = (static_cast<double>(random() >> 11) + 1) * unit;
  const double v = static_cast<double>(random() >> 11) * unit;
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * M_PI * v);
}

}  // namespace

ForceSensorConfig ForceSensorConfig::read(ConfigReader& reader) {
  ForceSensorConfig config;
  reader.number("axial_range", config.axial_range, Range::positive());
  reader.number("lateral_range", config.lateral_range, Range::positive());
  reader.number("axial_noise", config.axial_noise, Range::nonNegative());
  reader.number("lateral_noise", config.lateral_noise, Range::nonNegative());
  reader.number("natural_frequency", config.natural_frequency, Range::positive());
  reader.number("damping_ratio", config.damping_ratio, Range::positive());
  reader.number("cross_axis", config.cross_axis, Range::closed(0, 1));
  reader.integer("bits", config.bits, Range::closed(4, 32));
  reader.integer("seed", config.seed, Range::closed(0, 2147483647));
  return config;
}

ForceSensor::ForceSensor(const ForceSensorConfig& config)
    : config_(config), random_(static_cast<std::uint64_t>(config.seed)) {}

void ForceSensor::respond(const Eigen::Vector2d& force, double dt) {
  if (dt != transition_dt_) {
    const double omega = 2 * M_PI * config_.natural_frequency;
    Eigen::Matrix2d rate;
    rate << 0, 1, -omega * omega, -2 * config_.damping_ratio * omega;
    transition_ = Eigen::Matrix2d(rate * dt).exp();
    transition_dt_ = dt;
  }
  // Exact for a force that is constant over the step: the deviation from the new rest decays.
  Eigen::Matrix2d rest = Eigen::Matrix2d::Zero();
  rest.row(0) = force.transpose();
  state_ = rest + transition_ * (state_ - rest);
}

Eigen::Vector2d ForceSensor::sample(const Eigen::Vector2d& force, double dt) {
  respond(force, dt);
  const Eigen::Vector2d range(config_.axial_range, config_.lateral_range);
  const Eigen::Vector2d noise(config_.axial_noise, config_.lateral_noise);
  Eigen::Vector2d reading = state_.row(0).transpose() + config_.cross_axis * state_.row(0).reverse().transpose();
  saturated_ = false;
  for (int i = 0; i < 2; ++i) {
    reading[i] += noise[i] * standardNormal(random_);
    saturated_ = saturated_ || std::abs(reading[i]) > range[i];
    const double step = 2 * range[i] / std::pow(2.0, config_.bits);
    reading[i] = std::clamp(std::round(reading[i] / step) * step, -range[i], range[i]);
  }
  return reading;
}

}  // namespace microinjection
