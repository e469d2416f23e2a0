// How Micromanipulator's set-point goes on from step to step, by the kind of the last command.

#include <algorithm>
#include <cmath>
#include <limits>

#include "rig/manipulator/approach_speed.h"
#include "rig/manipulator/micromanipulator.h"

namespace microinjection {

void Micromanipulator::abortMotion(const std::string& why) {
  ended_ = why;
  mode_ = Mode::kBrake;
}

void Micromanipulator::arrive() {
  setpoint_->velocity.setZero();
  mode_ = Mode::kHold;
}

/// Why the device, which goes straight to where it is sent from where it is, cannot; else empty. One that follows keeps
/// to the set-point's way, unless an exchange was lost or it comes far behind.
std::string Micromanipulator::blocksDevice(const Eigen::Vector3d& target) const {
  const Eigen::Vector3d measured = device_->reading()->joints;
  const bool near = setpoint_ && (measured - setpoint_->position).norm() <= config_.collision_margin;
  return accepts_setpoints_while_moving_ && near ? "" : guard_.blocksPath(measured, target);
}

/// Something brought the device elsewhere, and an obstacle between itself and where it was sent.
void Micromanipulator::haltIfCutOff() {
  if (mode_ == Mode::kHold && !(setpoint_ && device_->moving())) return;
  const std::string why = blocksDevice(setpoint_ ? setpoint_->position : goal_);
  if (why.empty()) return;
  halt();
  ended_ = "on the straight way from where the device is: " + why;
}

/// One step of the set-point with this velocity (m/s), or of braking where it could not brake in time afterwards: the
/// reason then.
std::string Micromanipulator::advance(const Eigen::Vector3d& velocity, double dt) {
  AxesMotion next{setpoint_->position + velocity * dt, velocity};
  const Eigen::Vector3d rest = reachOf(next);
  std::string why = geometry_.leavesTravel(setpoint_->position, rest);
  if (why.empty()) why = guard_.blocksPath(setpoint_->position, rest);
  if (!why.empty() || !blocksDevice(rest).empty()) {  // of the device: it waits until that has come nearer
    next = *setpoint_;
    brake(geometry_, next, dt);
  }
  setpoint_ = next;
  return why;
}

/// The set-point's speed (m/s) after one step in which it slows down as fast as it can.
double Micromanipulator::brakedSpeed(double dt) const {
  AxesMotion braked = *setpoint_;
  brake(geometry_, braked, dt);
  return (geometry_.directions * braked.velocity).norm();
}

void Micromanipulator::stepServo(double dt) {
  goal_age_ += dt;
  Eigen::Vector3d goal_velocity = Eigen::Vector3d::Zero();
  if (goal_is_new_) {
    // Of a stream with a command or two a step; a lone command's goal stands still.
    if (goal_age_ < 2.5 * dt) goal_velocity = (goal_ - last_goal_) / goal_age_;
    if (!geometry_.tooFast(goal_velocity * (1 - 1e-9)).empty()) goal_velocity.setZero();
    goal_age_ = 0;
    goal_is_new_ = false;
  }
  if (goal_age_ > config_.command_timeout) {
    if (!atRest(geometry_, *setpoint_, goal_, dt) || device_->moving()) {
      halt();
      ended_ = "servo_cp is stale";
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
  // A set-point that is still faster, from a move before, may slow down as its axes can.
  const double speed = (geometry_.directions * velocity).norm();
  const double allowed = std::max(config_.servo_speed_limit, brakedSpeed(dt));
  if (speed > allowed) velocity *= allowed / speed;
  advance(velocity, dt);
}

void Micromanipulator::stepMove(double dt) {
  if (!setpoint_) {  // the device goes by itself
    if (!device_->moving()) rest();
    return;
  }
  double speed = std::numeric_limits<double>::infinity();
  if (lag_ > 0) {  // so slowly towards the end that a device which hears of it late does not go past
    double least = speed;
    for (const auto& axis : geometry_.axes) least = std::min(least, axis.acceleration);
    speed = std::max(approachSpeed((goal_ - setpoint_->position).norm(), least, 2 * lag_),
                     device_->abilities().resolution / lag_);
  }
  const std::string why = advance(straightVelocity(geometry_, *setpoint_, goal_, speed, dt), dt);
  if (!why.empty()) return abortMotion(why);
  if (!atRest(geometry_, *setpoint_, goal_, dt)) return;
  setpoint_->position = goal_;
  arrive();
}

void Micromanipulator::stepVelocity(double time, double dt) {
  const bool stale = time - velocity_command_time_ > config_.velocity_command_timeout;
  const Eigen::Vector3d wanted = stale ? Eigen::Vector3d::Zero() : velocity_command_;
  // Along the straight change of velocity, so that the axes come to the new direction together.
  const Eigen::Vector3d change = wanted - setpoint_->velocity;
  const double time_needed = brakingTime(geometry_, change);
  const Eigen::Vector3d velocity =
      time_needed > dt ? Eigen::Vector3d(setpoint_->velocity + change * (dt / time_needed)) : wanted;
  const std::string why = advance(velocity, dt);
  if (!why.empty()) return abortMotion(why);
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
