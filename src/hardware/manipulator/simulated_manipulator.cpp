#include "hardware/manipulator/simulated_manipulator.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

SimulatedManipulatorConfig SimulatedManipulatorConfig::read(ConfigReader& reader) {
  SimulatedManipulatorConfig config;
  reader.number("servo_time_constant", config.servo_time_constant, Range::nonNegative());
  reader.number("resolution", config.resolution, Range::nonNegative());
  reader.number("backlash", config.backlash, Range::nonNegative());
  ConfigReader hysteresis = reader.section("hysteresis");
  config.hysteresis = HysteresisConfig::read(hysteresis);
  reader.vector("drift_rate", config.drift_rate);
  reader.number("drift_walk", config.drift_walk, Range::nonNegative());
  reader.integer("seed", config.seed, Range::nonNegative());
  return config;
}

SimulatedManipulator::SimulatedManipulator(const ManipulatorGeometry& geometry,
                                           const SimulatedManipulatorConfig& config)
    : geometry_(geometry), config_(config), random_(static_cast<std::uint64_t>(config.seed)) {
  hysteresis_.fill(Hysteresis(config.hysteresis));
}

ManipulatorAbilities SimulatedManipulator::abilities() const {
  ManipulatorAbilities abilities;
  abilities.device = "simulated";
  abilities.follows = true;
  abilities.resolution = config_.resolution;
  abilities.speed = geometry_.velocities().maxCoeff();
  const double slowest_stop = brakingTime(geometry_, geometry_.velocities());
  abilities.stop_time = slowest_stop + 5 * config_.servo_time_constant;  // until 1 % of the lag remains
  return abilities;
}

void SimulatedManipulator::follow(const Eigen::Vector3d& joints, const Eigen::Vector3d& velocity) {
  if (!fault_.empty()) return;
  setpoint_ = {joints, velocity};
  mode_ = Mode::kFollow;
}

void SimulatedManipulator::moveTo(const Eigen::Vector3d& joints, double speed) {
  if (!fault_.empty()) return;
  goal_ = joints;
  speed_ = speed;
  mode_ = Mode::kMove;
}

void SimulatedManipulator::stop() { mode_ = Mode::kStop; }

void SimulatedManipulator::injectFault(const std::string& reason) {
  fault_ = reason;
  stop();
}

void SimulatedManipulator::clearFault() { fault_.clear(); }

void SimulatedManipulator::step(double time) {
  const double dt = time_ ? time - *time_ : 0;
  time_ = time;
  if (!(dt > 0)) return;
  stepSetpoint(dt);
  stepMotors(dt);
  stepTip(dt);
}

void SimulatedManipulator::stepSetpoint(double dt) {
  if (mode_ == Mode::kMove) {
    setpoint_.velocity = straightVelocity(geometry_, setpoint_, goal_, speed_, dt);
    setpoint_.position += setpoint_.velocity * dt;
    if (atRest(geometry_, setpoint_, goal_, dt)) setpoint_ = {goal_, Eigen::Vector3d::Zero()};
  } else if (mode_ == Mode::kStop) {
    brake(geometry_, setpoint_, dt);
  }
}

void SimulatedManipulator::stepMotors(double dt) {
  Eigen::Vector3d wanted = setpoint_.position;
  if (config_.resolution > 0) wanted = (wanted / config_.resolution).array().round() * config_.resolution;
  const double share = config_.servo_time_constant > 0 ? 1 - std::exp(-dt / config_.servo_time_constant) : 1;
  const Eigen::Vector3d moved = share * (wanted - motors_);
  motors_ += moved;
  motor_velocity_ = moved / dt;
}

void SimulatedManipulator::stepTip(double dt) {
  std::normal_distribution<double> normal;
  for (int i = 0; i < 3; ++i) {
    after_backlash_[i] =
        std::clamp(after_backlash_[i], motors_[i] - config_.backlash / 2, motors_[i] + config_.backlash / 2);
    drift_[i] += config_.drift_rate[i] * dt + config_.drift_walk * std::sqrt(dt) * normal(random_);
    tip_[i] = hysteresis_[i].follow(after_backlash_[i]) + drift_[i];
  }
}

bool SimulatedManipulator::moving() const {
  if (mode_ == Mode::kMove && setpoint_.position != goal_) return true;
  const double near = std::max(config_.resolution, kArrived);
  return !setpoint_.velocity.isZero() || (setpoint_.position - motors_).cwiseAbs().maxCoeff() > near;
}

}  // namespace microinjection
