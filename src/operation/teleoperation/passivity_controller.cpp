#include "operation/teleoperation/passivity_controller.h"

#include <algorithm>

namespace microinjection {
namespace {

// Used share of the reserve; the rest covers the error of the predicted velocity in a period.
constexpr double kSpent = 0.5;
// s without contact, after which an earlier oscillation does not matter any more.
constexpr double kFreeTime = 0.5;

}  // namespace

PassivityConfig PassivityConfig::read(ConfigReader reader) {
  PassivityConfig config;
  reader.boolean("enabled", config.enabled);
  reader.number("reserve", config.reserve, Range::positive());
  config.gate = EnergyGateConfig::read(reader);
  config.ripple = RippleConfig::read(reader.section("ripple"));
  reader.number("contact_force", config.contact_force, Range::positive());
  reader.number("storage_floor", config.storage_floor, Range::closed(0, 0.5));
  reader.number("storage_ceiling", config.storage_ceiling, Range::closed(0.5, 1));
  return config;
}

void PassivityController::reset() {
  velocity_.reset();
  balance_ = kSpent * config_.reserve;
  total_ = 0;
  contact_.reset();
  rendered_.setZero();
  has_last_ = paused_ = false;
  gate_.reset();
  ripple_.reset();
}

void PassivityController::observe(const Eigen::Vector3d& position, double dt) {
  const Eigen::Vector3d displacement = has_last_ ? Eigen::Vector3d(position - last_) : Eigen::Vector3d::Zero();
  last_ = position;
  has_last_ = true;
  velocity_.add(position, dt);
  // Motion of the hand while the needle is held is no ripple.
  if (paused_)
    ripple_.reset();
  else
    ripple_.observe(rendered_, position, dt);
  const double taken = -rendered_.dot(displacement);
  balance_ += taken;
  total_ += taken;
  if (!paused_) contact_.move(displacement);
  paused_ = false;
}

void PassivityController::followContact(const Eigen::Vector3d& contact_force, double dt) {
  contact_.setForce(contact_force);
  if (!contact_.isTouching()) {
    ripple_.reset();
    free_ += dt;
    if (free_ > kFreeTime) gate_.resetReturnTime();
  } else {
    free_ = 0;
  }
  if (config_.behind_channel) return;
  balance_ = std::min(balance_, kSpent * config_.reserve + config_.storage_ceiling * contact_.contactWork());
}

Eigen::Vector3d PassivityController::control(const Eigen::Vector3d& wanted, const Eigen::Vector3d& contact_force,
                                             double dt) {
  followContact(contact_force, dt);
  if (!config_.enabled) return wanted;
  if (config_.behind_channel) return gate_.step(wanted, velocity_.value(), balance_, dt);
  return gate_.step(wanted - gate_.damping(ripple_.energy_deficit(), ripple_.velocity()) * ripple_.velocity(),
                    velocity_.value(), balance_ - config_.storage_floor * contact_.contactWork(), dt);
}

}  // namespace microinjection
