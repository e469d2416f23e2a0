#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// How the device's axes lie in the microscope's view, and the view in `world`.
struct FrameMappingConfig {
  std::string device_axes = "x y z";  ///< the device's axes along the view's x, y, z, e.g. "x -z y"
  Eigen::Vector3d view_rotation =
      Eigen::Vector3d::Zero();  ///< rad, roll pitch yaw (about fixed axes) of the view in `world`

  /// Keys device_axes and view_rotation. Axes that are no rotation (repeated, mirrored) are an error.
  static FrameMappingConfig read(ConfigReader& reader);
};

/// Rotation between the haptic device's axes and `world`: what moves right in the hand moves right in the image.
class FrameMapping {
 public:
  /// @throws ConfigError when the axes are no rotation.
  explicit FrameMapping(const FrameMappingConfig& config);

  Eigen::Vector3d toWorld(const Eigen::Vector3d& in_device) const { return rotation_ * in_device; }
  Eigen::Vector3d toDevice(const Eigen::Vector3d& in_world) const { return rotation_.transpose() * in_world; }
  const Eigen::Matrix3d& rotation() const { return rotation_; }  ///< device to `world`

 private:
  Eigen::Matrix3d rotation_;
};

}  // namespace microinjection
