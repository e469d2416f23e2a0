#include "hardware/manipulator/micromanipulator.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

constexpr double kHere = 1e-6;  ///< m, from the needle, of a command that moves nothing

}  // namespace

MicromanipulatorConfig MicromanipulatorConfig::read(ConfigReader& reader) {
  MicromanipulatorConfig config;
  reader.number("pipette_tilt", config.pipette_tilt);
  reader.number("collision_margin", config.collision_margin, Range::nonNegative());
  reader.number("command_timeout", config.command_timeout, Range::positive());
  reader.number("velocity_command_timeout", config.velocity_command_timeout, Range::positive());
  reader.number("servo_speed_limit", config.servo_speed_limit, Range::positive());
  return config;
}

Micromanipulator::Micromanipulator(const ManipulatorGeometry& geometry, const CollisionGuard& guard,
                                   const MicromanipulatorConfig& config, ManipulatorDevice& device)
    : geometry_(geometry),
      guard_(guard),
      config_(config),
      device_(&device),
      accepts_setpoints_while_moving_(device.abilities().follows) {
  adapt();
  device.limitSpeed(geometry.velocities());
  if (const auto ends = device.homingEnds()) device.planHoming(planHoming(geometry, guard, *ends));
}

/// A driver measures the latency of its line after connecting, so the abilities can change.
void Micromanipulator::adapt() {
  const ManipulatorAbilities abilities = device_->abilities();
  lag_ = accepts_setpoints_while_moving_ ? abilities.latency + abilities.command_interval : 0;
}

std::string Micromanipulator::unavailableReason() const {
  if (device_->state() != ManipulatorDevice::State::kReady) {
    return device_->reason().empty() ? "the device is not ready" : device_->reason();
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

/// Where and how fast the next command starts: at the set-point, or at the measured position when
/// at rest.
AxesMotion Micromanipulator::start() const {
  const bool resting = mode_ == Mode::kHold && !device_->moving();
  if (setpoint_ && !resting) return *setpoint_;
  const ManipulatorDevice::Reading reading = *device_->reading();
  if (resting) return {reading.joints, Eigen::Vector3d::Zero()};
  const Eigen::Vector3d largest = geometry_.velocities();
  return {reading.joints, reading.velocity.cwiseMax(-largest).cwiseMin(largest)};
}

Eigen::Vector3d Micromanipulator::restAfter(const AxesMotion& motion) const {
  return motion.position + motion.velocity * brakingTime(geometry_, motion.velocity) / 2;
}

/// Where the device may come to rest if it is stopped now.
Eigen::Vector3d Micromanipulator::reachOf(const AxesMotion& motion) const {
  return restAfter(motion) + motion.velocity * lag_;
}

void Micromanipulator::begin(Mode mode, const AxesMotion& from) {
  mode_ = mode;
  move_active_ = mode == Mode::kMove;
  setpoint_ = from;
  abort_reason_.clear();
}

std::string Micromanipulator::streamHold() const {
  if (std::string reason = unavailableReason(); !reason.empty()) return reason;
  if (!streams_blocked_ || stream_pause_ > config_.command_timeout) return "";
  return "the needle was stopped; a stream moves it again after a pause of " + std::to_string(config_.command_timeout) +
         " s or after enable";
}

/// Registers one command of a stream. Returns streamHold().
std::string Micromanipulator::streamRefusal() {
  std::string hold = streamHold();
  stream_pause_ = 0;
  if (hold.empty()) streams_blocked_ = false;
  return hold;
}

/// After a fault that was cleared, a stream that has waited at the needle goes on: one `enable` is enough.
void Micromanipulator::admitIfHere(const Eigen::Isometry3d& tip_pose) {
  if (!streams_blocked_ || !fault_cleared_ || !unavailableReason().empty()) return;
  const auto measured = tipPose();
  if (measured && (tip_pose.translation() - measured->translation()).norm() < kHere) streams_blocked_ = false;
}

std::string Micromanipulator::servoPosition(const Eigen::Isometry3d& tip_pose) {
  admitIfHere(tip_pose);
  if (std::string reason = streamRefusal(); !reason.empty()) return reason;
  const Commanded commanded = checkPose(tip_pose);
  if (!commanded.refusal.empty()) return commanded.refusal;
  const AxesMotion from = start();
  if (std::string reason = guard_.blocksPath(from.position, commanded.joints); !reason.empty()) return reason;
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
  if (std::string reason = unavailableReason(); !reason.empty()) return reason;
  const Commanded commanded = checkPose(tip_pose);
  if (!commanded.refusal.empty()) return commanded.refusal;
  const AxesMotion from = start();
  const Eigen::Vector3d turn = accepts_setpoints_while_moving_ ? restAfter(from) : device_->reading()->joints;
  if (std::string reason = guard_.blocksPath(turn, commanded.joints); !reason.empty()) return reason;
  goal_ = commanded.joints;
  begin(Mode::kMove, from);
  if (accepts_setpoints_while_moving_) return "";
  setpoint_.reset();
  const Eigen::Vector3d displacement = goal_ - turn;
  if (displacement.norm() > 0) device_->moveTo(goal_, straightSpeed(geometry_, displacement.normalized()));
  return "";
}

std::string Micromanipulator::servoVelocity(const Eigen::Vector3d& velocity, double time) {
  if (!velocity.allFinite()) return "velocity is not finite";
  if (std::string reason = streamRefusal(); !reason.empty()) return reason;
  const Eigen::Vector3d joint_velocity = geometry_.directions.inverse() * velocity;
  if (std::string reason = geometry_.tooFast(joint_velocity); !reason.empty()) return reason;
  if (velocity.norm() > config_.servo_speed_limit * (1 + 1e-9)) {
    std::ostringstream reason;
    reason << "speed = " << velocity.norm()
           << " m/s, allowed at most servo_speed_limit = " << config_.servo_speed_limit;
    return reason.str();
  }
  // After one step at this velocity the needle must still be able to brake before obstacles and the
  // ends of travel.
  const AxesMotion from = start();
  const Eigen::Vector3d rest = reachOf({from.position + joint_velocity * last_dt_, joint_velocity});
  if (!joint_velocity.isZero()) {
    if (std::string reason = geometry_.leavesTravel(from.position, rest); !reason.empty()) return reason;
    if (std::string reason = guard_.blocksPath(from.position, rest); !reason.empty()) return reason;
  }
  velocity_command_ = joint_velocity;
  velocity_command_time_ = time;
  begin(Mode::kVelocity, from);
  return "";
}

/// Deletes the set-point. The next command starts at the measured position.
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
  streams_blocked_ = true;
  fault_cleared_ = false;
}

void Micromanipulator::clearFault() {
  if (device_->state() == ManipulatorDevice::State::kReady) streams_blocked_ = false;
  fault_cleared_ = device_->state() != ManipulatorDevice::State::kReady;
  rest();
  device_->clearFault();
}

void Micromanipulator::step(double time, double dt) {
  if (last_dt_ == 0) device_->step(time - dt);  // initializes the device's clock
  last_dt_ = dt;
  stream_pause_ += dt;
  if (const std::string reason = unavailableReason(); !reason.empty()) {
    if (mode_ != Mode::kHold) abort_reason_ = reason;
    // A device that has lost its position may still have a goal, to which it would go on.
    device_->state() == ManipulatorDevice::State::kReady && !streams_blocked_ ? halt() : rest();
    move_active_ = false;
    if (!streams_blocked_) fault_cleared_ = false;  // it was ready in between
    streams_blocked_ = true;
  } else {
    haltIfBlocked();
  }
  if (mode_ != Mode::kHold) {
    stepMode(time, dt);
    if (setpoint_) device_->follow(setpoint_->position, setpoint_->velocity);
  }
  const bool was_ready = device_->state() == ManipulatorDevice::State::kReady;
  device_->step(time);
  if (!was_ready) adapt();
  if (mode_ == Mode::kHold && !device_->moving()) move_active_ = false;
}

std::optional<Eigen::Isometry3d> Micromanipulator::setpointPose() const {
  if (!unavailableReason().empty() || mode_ == Mode::kVelocity) return std::nullopt;
  const bool by_itself = mode_ == Mode::kMove && !setpoint_;
  return geometry_.tipPose(by_itself ? goal_ : start().position);
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
