// Micromanipulator: advances the set-point in each step, by the kind of the last command.

#include <algorithm>
#include <cmath>
#include <limits>

#include "rig/manipulator/approach_speed.h"
#include "rig/manipulator/micromanipulator.h"

namespace microinjection {

void Micromanipulator::abortMotion(const std::string& reason) {
  abort_reason_ = reason;
  mode_ = Mode::kBrake;
}

void Micromanipulator::arrive() {
  setpoint_->velocity.setZero();
  mode_ = Mode::kHold;
}

/// Returns the reason why the device cannot move straight from its measured position to the target,
/// else an empty text. A device that follows stays on the set-point's path unless an exchange was
/// lost or it lags far behind.
std::string Micromanipulator::blocksDevice(const Eigen::Vector3d& target) const {
  const Eigen::Vector3d measured = device_->reading()->joints;
  const bool near = setpoint_ && (measured - setpoint_->position).norm() <= config_.collision_margin;
  return accepts_setpoints_while_moving_ && near ? "" : guard_.blocksPath(measured, target);
}

/// Stops if the device was displaced so that an obstacle lies between it and its goal.
void Micromanipulator::haltIfBlocked() {
  if (mode_ == Mode::kHold && !(setpoint_ && device_->moving())) return;
  const std::string reason = blocksDevice(setpoint_ ? setpoint_->position : goal_);
  if (reason.empty()) return;
  halt();
  abort_reason_ = "on the straight path from the measured position: " + reason;
}

/// Advances the set-point by one step with this velocity (m/s). If it could not brake in time
/// afterwards, it brakes instead and the reason is returned.
std::string Micromanipulator::advance(const Eigen::Vector3d& velocity, double dt) {
  AxesMotion next{setpoint_->position + velocity * dt, velocity};
  const Eigen::Vector3d rest = reachOf(next);
  std::string reason = geometry_.leavesTravel(setpoint_->position, rest);
  if (reason.empty()) reason = guard_.blocksPath(setpoint_->position, rest);
  if (!reason.empty() || !blocksDevice(rest).empty()) {  // blocked for the device only: wait until it is closer
    next = *setpoint_;
    brake(geometry_, next, dt);
  }
  setpoint_ = next;
  return reason;
}

/// Speed (m/s) of the set-point after one step of full braking.
double Micromanipulator::brakedSpeed(double dt) const {
  AxesMotion braked = *setpoint_;
  brake(geometry_, braked, dt);
  return (geometry_.directions * braked.velocity).norm();
}

void Micromanipulator::stepServo(double dt) {
  goal_age_ += dt;
  Eigen::Vector3d goal_velocity = Eigen::Vector3d::Zero();
  if (goal_is_new_) {
    // Only a stream with at least one command per one or two steps has a velocity. The goal of a
    // single command is at rest.
    if (goal_age_ < 2.5 * dt) goal_velocity = (goal_ - last_goal_) / goal_age_;
    if (!geometry_.tooFast(goal_velocity * (1 - 1e-9)).empty()) goal_velocity.setZero();
    goal_age_ = 0;
    goal_is_new_ = false;
  }
  if (goal_age_ > config_.command_timeout) {
    if (!atRest(geometry_, *setpoint_, goal_, dt) || device_->moving()) {
      halt();
      abort_reason_ = "servo_cp is stale";
    } else {
      arrive();
    }
    return;
  }
  Eigen::Vector3d velocity;
  for (int i = 0; i < 3; ++i) {
    const ManipulatorGeometry::Axis& axis = geometry_.axes[i];
    const double behind = goal_[i] - setpoint_->position[i] - goal_velocity[i] * dt;
    const double catch_up = std::copysign(approachSpeed(std::abs(behind), axis.acceleration, dt), behind);
    const double change = axis.acceleration * dt;
    velocity[i] =
        std::clamp(goal_velocity[i] + catch_up, setpoint_->velocity[i] - change, setpoint_->velocity[i] + change);
    velocity[i] = std::clamp(velocity[i], -axis.velocity, axis.velocity);
  }
  // A set-point that is faster from a previous move may brake at the axes' deceleration.
  const double speed = (geometry_.directions * velocity).norm();
  const double allowed = std::max(config_.servo_speed_limit, brakedSpeed(dt));
  if (speed > allowed) velocity *= allowed / speed;
  advance(velocity, dt);
}

void Micromanipulator::stepMove(double dt) {
  if (!setpoint_) {  // the device executes the move
    if (!device_->moving()) rest();
    return;
  }
  double speed = std::numeric_limits<double>::infinity();
  if (lag_ > 0) {  // slow enough near the end that a device with latency does not overshoot
    double least = speed;
    for (const auto& axis : geometry_.axes) least = std::min(least, axis.acceleration);
    speed = std::max(approachSpeed((goal_ - setpoint_->position).norm(), least, 2 * lag_),
                     device_->abilities().resolution / lag_);
  }
  const std::string reason = advance(straightVelocity(geometry_, *setpoint_, goal_, speed, dt), dt);
  if (!reason.empty()) return abortMotion(reason);
  if (!atRest(geometry_, *setpoint_, goal_, dt)) return;
  setpoint_->position = goal_;
  arrive();
}

void Micromanipulator::stepVelocity(double time, double dt) {
  const bool stale = time - velocity_command_time_ > config_.velocity_command_timeout;
  const Eigen::Vector3d wanted = stale ? Eigen::Vector3d::Zero() : velocity_command_;
  // Changes the velocity along a straight line, so that all axes reach the new direction together.
  const Eigen::Vector3d change = wanted - setpoint_->velocity;
  const double time_needed = brakingTime(geometry_, change);
  const Eigen::Vector3d velocity =
      time_needed > dt ? Eigen::Vector3d(setpoint_->velocity + change * (dt / time_needed)) : wanted;
  const std::string reason = advance(velocity, dt);
  if (!reason.empty()) return abortMotion(reason);
  if (stale && setpoint_->velocity.isZero(0)) arrive();
}

void Micromanipulator::stepMode(double time, double dt) {
  switch (mode_) {
    case Mode::kHold:
      break;
    case Mode::kBrake:
      brake(geometry_, *setpoint_, dt);
      if (setpoint_->velocity.isZero(0)) arrive();
      break;
    case Mode::kServo:
      stepServo(dt);
      break;
    case Mode::kVelocity:
      stepVelocity(time, dt);
      break;
    case Mode::kMove:
      stepMove(dt);
      break;
  }
}

}  // namespace microinjection
