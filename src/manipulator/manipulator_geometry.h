#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

namespace microinjection {

/// Kinematics and limits of a three-axis micromanipulator, read from its URDF and from nowhere else.
struct ManipulatorGeometry {
  struct Axis {
    std::string joint;
    double lower = 0;     ///< m
    double upper = 0;     ///< m
    double velocity = 0;  ///< m/s, the largest
  };

  std::array<Axis, 3> axes;
  Eigen::Matrix3d directions;     ///< columns: unit vectors of the axes in `world`
  Eigen::Isometry3d tip_at_zero;  ///< pose of `needle_tip` in `world` with all joints at 0

  /// Reads the chain from link `world` to link `needle_tip`: exactly three prismatic joints, the others fixed.
  /// @throws ConfigError when the text is no URDF, or the chain or its limits are not as said.
  static ManipulatorGeometry fromUrdf(const std::string& xml);

  /// Tip position in `world` (m) from joint positions (m).
  Eigen::Vector3d tip(const Eigen::Vector3d& joints) const;
  /// Joint positions (m) that bring the tip to a position in `world` (m); not limited.
  Eigen::Vector3d joints(const Eigen::Vector3d& tip) const;
  /// Empty when the joint positions (m) are within travel, otherwise which axis is outside and what it allows.
  std::string outsideTravel(const Eigen::Vector3d& joints) const;
};

}  // namespace microinjection
