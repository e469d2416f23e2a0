#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

namespace microinjection {

/// Kinematics and limits of a three-axis micromanipulator, read from its URDF and from nowhere else.
struct ManipulatorGeometry {
  struct Axis {
    std::string joint;
    double lower = 0;         ///< m
    double upper = 0;         ///< m
    double velocity = 0;      ///< m/s, the largest
    double acceleration = 0;  ///< m/s^2, the largest
  };

  /// The pipette's inclination: an axis that a person sets by hand before the session.
  struct Tilt {
    std::string joint;  ///< empty: this rig has none
    double angle = 0;   ///< rad
  };

  std::array<Axis, 3> axes;
  Tilt tilt;
  Eigen::Matrix3d directions;     ///< columns: unit vectors of the axes in `world`
  Eigen::Isometry3d tip_at_zero;  ///< pose of `needle_tip` in `world` with all three joints at 0, tilted

  /// Reads the chain from link `world` to link `needle_tip`: exactly three prismatic joints, behind them one revolute
  /// joint or none, the others fixed.
  /// @param tilt_angle  rad, of the revolute joint
  /// @throws ConfigError when the text is no URDF, the chain or its limits are not as said, or the tilt is outside.
  static ManipulatorGeometry fromUrdf(const std::string& xml, double tilt_angle = 0);

  /// Tip position in `world` (m) from joint positions (m).
  Eigen::Vector3d tip(const Eigen::Vector3d& joints) const;
  /// Pose of `needle_tip` in `world` from joint positions (m).
  Eigen::Isometry3d tipPose(const Eigen::Vector3d& joints) const;
  /// Joint positions (m) that bring the tip to a position in `world` (m); not limited.
  Eigen::Vector3d joints(const Eigen::Vector3d& tip) const;
  /// Empty when the joint positions (m) are within travel, otherwise which axis is outside and what it allows.
  std::string outsideTravel(const Eigen::Vector3d& joints) const;
  /// The same of where a motion from `from` (m) leads: who is outside already may stay or come back, not go farther.
  std::string leavesTravel(const Eigen::Vector3d& from, const Eigen::Vector3d& joints) const;
  /// Empty when no axis is faster than it may be (m/s), otherwise which is and what it allows.
  std::string tooFast(const Eigen::Vector3d& joint_velocity) const;
};

}  // namespace microinjection
