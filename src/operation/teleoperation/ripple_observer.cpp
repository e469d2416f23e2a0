#include "operation/teleoperation/ripple_observer.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

RippleConfig RippleConfig::read(ConfigReader reader) {
  RippleConfig config;
  reader.number("cutoff", config.cutoff, Range::positive());
  reader.number("tolerance", config.tolerance, Range::positive());
  reader.number("memory", config.memory, Range::positive());
  return config;
}

void RippleObserver::observe(const Eigen::Vector3d& force, const Eigen::Vector3d& position, double dt) {
  if (!begun_) {
    last_force_ = force;
    last_position_ = position;
    begun_ = true;
  }
  const double keep = 1 / (1 + 2 * M_PI * config_.cutoff * dt);
  const Eigen::Vector3d before = position_;
  const double held_before = -0.5 * force_.dot(position_);
  force_ = keep * (force_ + force - last_force_);
  position_ = keep * (position_ + position - last_position_);
  last_force_ = force;
  last_position_ = position;
  // A low-pass of 5 ms removes the encoder's steps from the ripple's velocity.
  velocity_ += (1 - std::exp(-dt / 5e-3)) * ((position_ - before) / dt - velocity_);
  const double taken = -force_.dot(position_ - before);
  const double held = -0.5 * force_.dot(position_) - held_before;
  balance_ = std::min((1 - std::min(1.0, dt / config_.memory)) * balance_ + taken - held, config_.tolerance);
}

double RippleObserver::energy_deficit() const { return std::max(0.0, -balance_ - config_.tolerance); }

}  // namespace microinjection
