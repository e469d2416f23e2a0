#include "benchmark/common/simulated_needle.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

/// In [0, 1), the same with every standard library.
double uniformFrom(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

}  // namespace

SimulatedNeedleConfig drawnNeedle(std::uint64_t seed) {
  SimulatedNeedleConfig config;
  config.seed = seed;
  // The seed of the noise is another one, so that the truth and the noise are independent.
  std::mt19937_64 random(seed + 0x9e3779b97f4a7c15);
  const auto between = [&](double low, double high) { return low + (high - low) * uniformFrom(random); };
  config.value[kPixelSize] = between(0.1e-6, 0.2e-6);
  config.value[kAngle] = between(-3.14, 3.14);
  config.value[kSkew] = between(-0.05, 0.05);
  config.value[kAxisRatio] = between(0.97, 1.03);
  config.value[kDepthDriftX] = between(-0.02, 0.02);
  config.value[kDepthDriftZ] = between(-0.02, 0.02);
  config.value.segment<3>(kBacklashX).setConstant(2e-6);
  config.value[kTipU] = between(650, 750);
  config.value[kTipV] = between(480, 560);
  config.value[kFocusX] = between(-0.05, 0.05);
  config.value[kFocusY] = between(0.95, 1.05);
  config.value[kFocusZ] = between(-0.05, 0.05);
  config.value[kFocusZero] = between(-5e-6, 5e-6);
  config.mirrored = uniformFrom(random) < 0.5;
  return config;
}

SimulatedNeedle::SimulatedNeedle(const SimulatedNeedleConfig& config, const Eigen::Vector3d& position)
    : config_(config), random_(config.seed) {
  for (int i = 0; i < 3; ++i) place_[i] = position[i] + (uniform() - 0.5) * config.value[kBacklashX + i];
}

void SimulatedNeedle::moveTo(const Eigen::Vector3d& position) {
  for (int i = 0; i < 3; ++i) {
    const double half = 0.5 * config_.value[kBacklashX + i];
    place_[i] = std::clamp(place_[i], position[i] - half, position[i] + half);
  }
}

Eigen::Vector2d SimulatedNeedle::truePixel() const {
  return tipPixel<double>(config_.value, config_.mirrored, place_ - config_.origin);
}

Eigen::Vector2d SimulatedNeedle::seenPixel() {
  Eigen::Vector2d pixel = truePixel();
  if (uniform() < config_.outlier_share) {
    for (double& coordinate : pixel) coordinate += config_.outlier_size * (2 * uniform() - 1);
    return pixel;
  }
  for (double& coordinate : pixel) coordinate += config_.noise * normal();
  return pixel;
}

double SimulatedNeedle::seenFocus() {
  return tipFocus<double>(config_.value, place_ - config_.origin) + config_.focus_noise * normal();
}

double SimulatedNeedle::uniform() { return uniformFrom(random_); }

double SimulatedNeedle::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  return radius * std::cos(2 * 3.14159265358979323846 * uniform());
}

std::vector<TipObservation> SimulatedNeedle::observe(const std::vector<CalibrationWaypoint>& waypoints) {
  std::vector<TipObservation> observations;
  for (const CalibrationWaypoint& waypoint : waypoints) {
    moveTo(waypoint.position);
    TipObservation observation;
    observation.position = waypoint.position;
    if (waypoint.observe) observation.pixel = seenPixel();
    if (waypoint.focus) observation.focus = seenFocus();
    observations.push_back(observation);
  }
  return observations;
}

}  // namespace microinjection
