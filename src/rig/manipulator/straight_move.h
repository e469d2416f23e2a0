#pragma once

#include <Eigen/Core>

#include "rig/manipulator/manipulator_geometry.h"

namespace microinjection {

/// Set-point of the three axes that can start, go straight and brake, within the axes' accelerations.
struct AxesMotion {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

/// As near to a goal (m) as makes no difference to any device.
constexpr double kArrived = 1e-10;

/// Time (s) in which a motion comes to rest along its straight line: that of the axis that needs longest.
double brakingTime(const ManipulatorGeometry& geometry, const Eigen::Vector3d& velocity);

/// One step (s) of braking straight ahead. From velocity v it ends at the most v brakingTime / 2 farther.
void brake(const ManipulatorGeometry& geometry, AxesMotion& motion, double dt);

/// At its goal (m), and slow enough to rest there within a step (s).
bool atRest(const ManipulatorGeometry& geometry, const AxesMotion& motion, const Eigen::Vector3d& goal, double dt);

/// The largest speed (m/s) along a unit direction.
double straightSpeed(const ManipulatorGeometry& geometry, const Eigen::Vector3d& direction);

/// Velocity (m/s) of the next step (s) of a straight move to `goal` (m) at `speed` (m/s) or the axes' limits, to be
/// taken for that step; brakes first where the motion is not on that line.
Eigen::Vector3d straightVelocity(const ManipulatorGeometry& geometry, const AxesMotion& motion,
                                 const Eigen::Vector3d& goal, double speed, double dt);

}  // namespace microinjection
