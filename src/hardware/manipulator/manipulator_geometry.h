#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

namespace microinjection {

/// Kinematics and limits of a three-axis micromanipulator. Its URDF is their only source. What is called the tip is
/// that of the needle, or the mouth of the holding pipette, with a manipulator of its own.
struct ManipulatorGeometry {
  struct Axis {
    std::string joint;
    double lower = 0;         ///< m
    double upper = 0;         ///< m
    double velocity = 0;      ///< m/s, the largest
    double acceleration = 0;  ///< m/s^2, the largest
  };

  /// The pipette's inclination, which the operator sets by hand before the session.
  struct Tilt {
    std::string joint;  ///< empty: the rig has no tilt
    double angle = 0;   ///< rad
  };

  std::array<Axis, 3> axes;
  Tilt tilt;
  Eigen::Matrix3d directions;     ///< columns: unit vectors of the axes in `world`
  Eigen::Isometry3d tip_at_zero;  ///< pose of the tip in `world` with all three joints at 0, tilted

  /// Reads the chain from link `world` to link `tip`: exactly three prismatic joints, then
  /// at most one revolute joint; all other joints are fixed.
  /// @param tilt_angle  rad, of the revolute joint
  /// @throws ConfigError for a text that is no URDF, another chain, invalid limits, or a tilt
  ///   beyond its limits.
  static ManipulatorGeometry fromUrdf(const std::string& xml, double tilt_angle = 0,
                                      const std::string& tip = "needle_tip");

  /// m/s and m/s^2, the largest of the axes.
  Eigen::Vector3d velocities() const { return {axes[0].velocity, axes[1].velocity, axes[2].velocity}; }
  Eigen::Vector3d accelerations() const { return {axes[0].acceleration, axes[1].acceleration, axes[2].acceleration}; }

  /// Tip position in `world` (m) from joint positions (m).
  Eigen::Vector3d tip(const Eigen::Vector3d& joints) const;
  /// Pose of the tip in `world` from joint positions (m).
  Eigen::Isometry3d tipPose(const Eigen::Vector3d& joints) const;
  /// Joint positions (m) for a tip position in `world` (m), without limits.
  Eigen::Vector3d joints(const Eigen::Vector3d& tip) const;
  /// Returns an empty text when the joint positions (m) are within the travel, otherwise the axis
  /// and its limits.
  std::string outsideTravel(const Eigen::Vector3d& joints) const;
  /// The same check for the end of a motion from `from` (m). An axis that is already outside its
  /// travel may stay or return, but not move farther out.
  std::string leavesTravel(const Eigen::Vector3d& from, const Eigen::Vector3d& joints) const;
  /// Returns an empty text when no axis exceeds its speed (m/s), otherwise the axis and its limit.
  std::string tooFast(const Eigen::Vector3d& joint_velocity) const;
};

}  // namespace microinjection
