#include "hardware/manipulator/straight_move.h"

#include <algorithm>

namespace microinjection {
namespace {

/// The largest magnitude along a unit direction with which no axis exceeds its limit.
double straightLimit(const Eigen::Vector3d& limits, const Eigen::Vector3d& direction) {
  return (limits.array() / direction.array().abs()).minCoeff();
}

Eigen::Vector3d braked(const ManipulatorGeometry& geometry, const Eigen::Vector3d& velocity, double dt) {
  const double time = brakingTime(geometry, velocity);
  return time > dt ? Eigen::Vector3d(velocity * (1 - dt / time)) : Eigen::Vector3d::Zero();
}

}  // namespace

double brakingTime(const ManipulatorGeometry& geometry, const Eigen::Vector3d& velocity) {
  return velocity.cwiseAbs().cwiseQuotient(geometry.accelerations()).maxCoeff();
}

void brake(const ManipulatorGeometry& geometry, AxesMotion& motion, double dt) {
  motion.velocity = braked(geometry, motion.velocity, dt);
  motion.position += motion.velocity * dt;
}

bool atRest(const ManipulatorGeometry& geometry, const AxesMotion& motion, const Eigen::Vector3d& goal, double dt) {
  return (goal - motion.position).norm() < kArrived && brakingTime(geometry, motion.velocity) <= dt;
}

double straightSpeed(const ManipulatorGeometry& geometry, const Eigen::Vector3d& direction) {
  return straightLimit(geometry.velocities(), direction);
}

Eigen::Vector3d straightVelocity(const ManipulatorGeometry& geometry, const AxesMotion& motion,
                                 const Eigen::Vector3d& goal, double speed, double dt) {
  const Eigen::Vector3d displacement = goal - motion.position;
  const double distance = displacement.norm();
  if (distance == 0) return braked(geometry, motion.velocity, dt);
  const Eigen::Vector3d direction = displacement / distance;
  const double forward = motion.velocity.dot(direction);
  const double acceleration = straightLimit(geometry.accelerations(), direction);
  const bool off_line = (motion.velocity - forward * direction).norm() > 1e-6 * motion.velocity.norm();
  const bool past = forward > acceleration * dt + approachSpeed(distance, acceleration, dt);
  if (forward < 0 || off_line || past) return braked(geometry, motion.velocity, dt);
  return direction * std::min({speed, straightSpeed(geometry, direction), approachSpeed(distance, acceleration, dt),
                               forward + acceleration * dt});
}

}  // namespace microinjection
