#pragma once

#include <Eigen/Core>
#include <cmath>

#include "hardware/manipulator/manipulator_geometry.h"

namespace microinjection {

/// Set-point of the three axes, which starts, moves straight and brakes within the axes'
/// accelerations.
struct AxesMotion {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

/// m, from a goal; no device resolves less.
constexpr double kArrived = 1e-10;

/// Time (s) in which a straight motion comes to rest: that of the slowest axis.
double brakingTime(const ManipulatorGeometry& geometry, const Eigen::Vector3d& velocity);

/// One step (s) of braking without a change of direction. From velocity v it travels at most v
/// brakingTime / 2.
void brake(const ManipulatorGeometry& geometry, AxesMotion& motion, double dt);

/// At its goal (m), and slow enough to stop within one step (s).
bool atRest(const ManipulatorGeometry& geometry, const AxesMotion& motion, const Eigen::Vector3d& goal, double dt);

/// The largest speed (m/s) along a unit direction.
double straightSpeed(const ManipulatorGeometry& geometry, const Eigen::Vector3d& direction);

/// Velocity (m/s) for the next step (s) of a straight move to `goal` (m) at `speed` (m/s) or the
/// axes' limits. A motion that is not on that line brakes first.
Eigen::Vector3d straightVelocity(const ManipulatorGeometry& geometry, const AxesMotion& motion,
                                 const Eigen::Vector3d& goal, double speed, double dt);

/// Largest speed (m/s) for the next `dt` (s) that does not pass a point `distance` (m, >= 0) ahead:
/// v dt + v^2 / (2 a) = distance, with the deceleration a (m/s^2). Applied in each step, it
/// decelerates by at most a, whatever dt is, and ends exactly at the point.
inline double approachSpeed(double distance, double acceleration, double dt) {
  return 2 * distance / (std::sqrt(dt * dt + 2 * distance / acceleration) + dt);
}

}  // namespace microinjection
