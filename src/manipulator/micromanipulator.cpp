#include "manipulator/micromanipulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "manipulator/approach_speed.h"

namespace microinjection {

MicromanipulatorConfig MicromanipulatorConfig::read(ConfigReader& reader) {
  MicromanipulatorConfig config;
  reader.number("pipette_tilt", config.pipette_tilt);
  reader.number("collision_margin", config.collision_margin, Range::nonNegative());
  reader.number("command_timeout", config.command_timeout, Range::positive());
  reader.number("velocity_command_timeout", config.velocity_command_timeout, Range::positive());
  return config;
}

Micromanipulator::Micromanipulator(const ManipulatorGeometry& geometry, const CollisionGuard& guard,
                                   const MicromanipulatorConfig& config, ManipulatorDevice& device)
    : geometry_(geometry),
      guard_(guard),
      config_(config),
      device_(&device),
      follows_(device.abilities().follows),
      lag_(follows_ ? device.abilities().latency + device.abilities().command_interval : 0) {
  device.limitSpeed({geometry.axes[0].velocity, geometry.axes[1].velocity, geometry.axes[2].velocity});
}

std::string Micromanipulator::unable() const {
  if (device_->state() != ManipulatorDevice::State::kReady) {
    return device_->why().empty() ? "the device is not ready" : device_->why();
  }
  return device_->reading() ? "" : "the device does not know its position yet";
}

Micromanipulator::Commanded Micromanipulator::checkPose(const Eigen::Isometry3d& tip_pose) const {
  if (!tip_pose.matrix().allFinite()) return {{}, "pose is not finite"};
  const double angle = Eigen::AngleAxisd(geometry_.tip_at_zero.linear().transpose() * tip_pose.linear()).angle();
  if (angle > 1e-3)
    return {{}, "orientation differs from the pipette's by " + std::to_string(angle) + " rad, allowed 0.001"};
  const Eigen::Vector3d joints = geometry_.joints(tip_pose.translation());
  const std::string outside = geometry_.outsideTravel(joints);
  return {joints, outside.empty() ? guard_.blocks(joints) : outside};
}

/// From where and how fast the next command takes over: on from the set-point, or from what the device measures.
AxesMotion Micromanipulator::start() const {
  const bool resting = mode_ == Mode::kHold && !device_->moving();
  if (setpoint_ && !resting) return *setpoint_;
  const ManipulatorDevice::Reading reading = *device_->reading();
  AxesMotion motion{reading.joints, Eigen::Vector3d::Zero()};
  if (!resting) {
    for (int i = 0; i < 3; ++i) {
      const double largest = geometry_.axes[i].velocity;
      motion.velocity[i] = std::clamp(reading.velocity[i], -largest, largest);
    }
  }
  return motion;
}

Eigen::Vector3d Micromanipulator::restAfter(const AxesMotion& motion) const {
  return motion.position + motion.velocity * brakingTime(geometry_, motion.velocity) / 2;
}

/// Where the device may get to when it is told to rest now.
Eigen::Vector3d Micromanipulator::reachOf(const AxesMotion& motion) const {
  return restAfter(motion) + motion.velocity * lag_;
}

void Micromanipulator::begin(Mode mode, const AxesMotion& from) {
  mode_ = mode;
  setpoint_ = from;
  ended_.clear();
}

/// Why nothing may be moved by a stream, of which one command is here; else empty.
std::string Micromanipulator::streamRefusal() {
  const bool begins = std::exchange(stream_pause_, 0) > config_.command_timeout;
  if (std::string why = unable(); !why.empty()) return why;
  if (begins) held_off_ = false;
  if (!held_off_) return "";
  return "the needle was stopped; a stream moves it again after a pause of " + std::to_string(config_.command_timeout) +
         " s or after enable";
}

std::string Micromanipulator::servoPosition(const Eigen::Isometry3d& tip_pose) {
  if (std::string why = streamRefusal(); !why.empty()) return why;
  const Commanded commanded = checkPose(tip_pose);
  if (!commanded.refusal.empty()) return commanded.refusal;
  const AxesMotion from = start();
  if (std::string why = guard_.blocksWay(from.position, commanded.joints); !why.empty()) return why;
  if (mode_ != Mode::kServo) {
    goal_ = from.position;
    goal_age_ = 0;
    goal_is_new_ = false;
  }
  if (!goal_is_new_) last_goal_ = goal_;
  goal_ = commanded.joints;
  goal_is_new_ = true;
  begin(Mode::kServo, from);
  return "";
}

std::string Micromanipulator::movePosition(const Eigen::Isometry3d& tip_pose) {
  if (std::string why = unable(); !why.empty()) return why;
  const Commanded commanded = checkPose(tip_pose);
  if (!commanded.refusal.empty()) return commanded.refusal;
  const AxesMotion from = start();
  const Eigen::Vector3d turn = follows_ ? restAfter(from) : device_->reading()->joints;
  if (std::string why = guard_.blocksWay(turn, commanded.joints); !why.empty()) return why;
  goal_ = commanded.joints;
  begin(Mode::kMove, from);
  if (follows_) return "";
  setpoint_.reset();
  const Eigen::Vector3d way = goal_ - turn;
  if (way.norm() > 0) device_->moveTo(goal_, straightSpeed(geometry_, way.normalized()));
  return "";
}

std::string Micromanipulator::servoVelocity(const Eigen::Vector3d& velocity, double time) {
  if (!velocity.allFinite()) return "velocity is not finite";
  if (std::string why = streamRefusal(); !why.empty()) return why;
  const Eigen::Vector3d joint_velocity = geometry_.directions.inverse() * velocity;
  if (std::string why = geometry_.tooFast(joint_velocity); !why.empty()) return why;
  // Too near to an end of its travel or to an obstacle to go that way for a step and come to rest before it?
  const AxesMotion from = start();
  const Eigen::Vector3d rest = reachOf({from.position + joint_velocity * last_dt_, joint_velocity});
  if (!joint_velocity.isZero()) {
    if (std::string why = geometry_.leavesTravel(from.position, rest); !why.empty()) return why;
    if (std::string why = guard_.blocksWay(from.position, rest); !why.empty()) return why;
  }
  velocity_command_ = joint_velocity;
  velocity_command_time_ = time;
  begin(Mode::kVelocity, from);
  return "";
}

/// Forgets the set-point: the next command starts from what the device measures.
void Micromanipulator::rest() {
  mode_ = Mode::kHold;
  setpoint_.reset();
}

void Micromanipulator::halt() {
  device_->stop();
  rest();
}

void Micromanipulator::stop() {
  halt();
  held_off_ = true;
}

void Micromanipulator::clearFault() {
  if (device_->state() == ManipulatorDevice::State::kReady) held_off_ = false;
  rest();
  device_->clearFault();
}

void Micromanipulator::endEarly(const std::string& why) {
  ended_ = why;
  mode_ = Mode::kBrake;
}

void Micromanipulator::arrive() {
  setpoint_->velocity.setZero();
  mode_ = Mode::kHold;
}

/// One step of the set-point with this velocity (m/s), or of braking where it could not brake in time afterwards: the
/// reason then.
std::string Micromanipulator::advance(const Eigen::Vector3d& velocity, double dt) {
  AxesMotion next{setpoint_->position + velocity * dt, velocity};
  const Eigen::Vector3d rest = reachOf(next);
  std::string why = geometry_.leavesTravel(setpoint_->position, rest);
  if (why.empty()) why = guard_.blocksWay(setpoint_->position, rest);
  // A device that goes from move to move takes the straight way from where it is.
  if (why.empty() && !follows_) why = guard_.blocksWay(device_->reading()->joints, rest);
  if (!why.empty()) {
    next = *setpoint_;
    brake(geometry_, next, dt);
  }
  setpoint_ = next;
  return why;
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
  if (!why.empty()) return endEarly(why);
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
  if (!why.empty()) return endEarly(why);
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

void Micromanipulator::step(double time, double dt) {
  if (last_dt_ == 0) device_->step(time - dt);  // sets its clock
  last_dt_ = dt;
  stream_pause_ += dt;
  if (!unable().empty()) {
    rest();
    held_off_ = true;
  }
  if (mode_ != Mode::kHold) {
    stepMode(time, dt);
    if (setpoint_) device_->follow(setpoint_->position, setpoint_->velocity);
  }
  device_->step(time);
}

std::optional<Eigen::Isometry3d> Micromanipulator::tipPose() const {
  const auto measured = joints();
  if (!measured) return std::nullopt;
  return geometry_.tipPose(*measured);
}

std::optional<Eigen::Vector3d> Micromanipulator::tipVelocity() const {
  const auto reading = device_->reading();
  if (!reading) return std::nullopt;
  return geometry_.directions * reading->velocity;
}

std::optional<Eigen::Vector3d> Micromanipulator::joints() const {
  const auto reading = device_->reading();
  if (!reading) return std::nullopt;
  return reading->joints;
}

}  // namespace microinjection
