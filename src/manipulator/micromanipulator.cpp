#include "manipulator/micromanipulator.h"

#include <algorithm>
#include <cmath>

namespace microinjection {

MicromanipulatorConfig MicromanipulatorConfig::read(ConfigReader& reader) {
  MicromanipulatorConfig config;
  reader.number("servo_time_constant", config.servo_time_constant, Range::nonNegative());
  reader.number("acceleration", config.acceleration, Range::positive());
  reader.number("velocity_command_timeout", config.velocity_command_timeout, Range::positive());
  return config;
}

Micromanipulator::Micromanipulator(const ManipulatorGeometry& geometry, const MicromanipulatorConfig& config)
    : geometry_(geometry), config_(config) {}

std::string Micromanipulator::checkPose(const Eigen::Isometry3d& tip_pose, Eigen::Vector3d& joints) const {
  if (!tip_pose.matrix().allFinite()) return "pose is not finite";
  const double angle = Eigen::AngleAxisd(geometry_.tip_at_zero.linear().transpose() * tip_pose.linear()).angle();
  if (angle > 1e-3) return "orientation differs from the pipette's by " + std::to_string(angle) + " rad, allowed 0.001";
  joints = geometry_.joints(tip_pose.translation());
  return geometry_.outsideTravel(joints);
}

std::string Micromanipulator::servoPosition(const Eigen::Isometry3d& tip_pose) {
  Eigen::Vector3d joints;
  const std::string refusal = checkPose(tip_pose, joints);
  if (!refusal.empty()) return refusal;
  goal_ = joints;
  mode_ = Mode::kServo;
  return "";
}

std::string Micromanipulator::movePosition(const Eigen::Isometry3d& tip_pose) {
  Eigen::Vector3d joints;
  const std::string refusal = checkPose(tip_pose, joints);
  if (!refusal.empty()) return refusal;
  goal_ = joints;
  if (mode_ != Mode::kMove) profile_velocity_.setZero();
  mode_ = Mode::kMove;
  return "";
}

std::string Micromanipulator::servoVelocity(const Eigen::Vector3d& velocity, double time) {
  if (!velocity.allFinite()) return "velocity is not finite";
  const Eigen::Vector3d joint_velocity = geometry_.directions.inverse() * velocity;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(joint_velocity[i]) > geometry_.axes[i].velocity) {
      return geometry_.axes[i].joint + " velocity = " + std::to_string(joint_velocity[i]) + " m/s, allowed +-" +
             std::to_string(geometry_.axes[i].velocity) + " m/s";
    }
  }
  velocity_command_ = joint_velocity;
  velocity_command_time_ = time;
  if (mode_ != Mode::kVelocity) profile_velocity_.setZero();
  mode_ = Mode::kVelocity;
  return "";
}

void Micromanipulator::stop() {
  mode_ = Mode::kHold;
  profile_velocity_.setZero();
}

void Micromanipulator::advanceSetpoint(const Eigen::Vector3d& joint_step, double dt) {
  for (int i = 0; i < 3; ++i) {
    const ManipulatorGeometry::Axis& axis = geometry_.axes[i];
    const double largest = axis.velocity * dt;
    setpoint_[i] = std::clamp(setpoint_[i] + std::clamp(joint_step[i], -largest, largest), axis.lower, axis.upper);
  }
}

void Micromanipulator::stepMove(double dt) {
  const Eigen::Vector3d distance = goal_ - setpoint_;
  if (distance.norm() < 1e-10) {
    setpoint_ = goal_;
    stop();
    return;
  }
  // Along the straight line to the goal: accelerate, cruise at the slowest axis' limit, brake in time.
  double cruise = geometry_.axes[0].velocity;
  for (const auto& axis : geometry_.axes) cruise = std::min(cruise, axis.velocity);
  const double braking = std::sqrt(2 * config_.acceleration * distance.norm());
  const double speed = std::min({cruise, braking, profile_velocity_.norm() + config_.acceleration * dt});
  profile_velocity_ = distance.normalized() * speed;
  advanceSetpoint(distance.normalized() * std::min(speed * dt, distance.norm()), dt);
}

void Micromanipulator::stepVelocity(double time, double dt) {
  const bool stale = time - velocity_command_time_ > config_.velocity_command_timeout;
  const Eigen::Vector3d wanted = stale ? Eigen::Vector3d::Zero() : velocity_command_;
  const double largest = config_.acceleration * dt;
  const Eigen::Vector3d change = wanted - profile_velocity_;
  profile_velocity_ += change.norm() > largest ? Eigen::Vector3d(change.normalized() * largest) : change;
  advanceSetpoint(profile_velocity_ * dt, dt);
  if (stale && profile_velocity_.isZero()) mode_ = Mode::kHold;
}

void Micromanipulator::step(double time, double dt) {
  if (mode_ == Mode::kServo) advanceSetpoint(goal_ - setpoint_, dt);
  if (mode_ == Mode::kMove) stepMove(dt);
  if (mode_ == Mode::kVelocity) stepVelocity(time, dt);
  const double share = config_.servo_time_constant > 0 ? 1 - std::exp(-dt / config_.servo_time_constant) : 1;
  const Eigen::Vector3d moved = share * (setpoint_ - joints_);
  joints_ += moved;
  joint_velocity_ = moved / dt;
}

Eigen::Isometry3d Micromanipulator::tipPose() const {
  Eigen::Isometry3d pose = geometry_.tip_at_zero;
  pose.translation() = geometry_.tip(joints_);
  return pose;
}

Eigen::Vector3d Micromanipulator::tipVelocity() const { return geometry_.directions * joint_velocity_; }

}  // namespace microinjection
