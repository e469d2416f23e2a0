#pragma once

#include <Eigen/Core>
#include <string>

#include "base/config_reader.h"

namespace microinjection {

/// Orientation of the device's axes in the microscope's view, and of the view in `world`.
struct FrameMappingConfig {
  std::string device_axes = "x y z";  ///< the device's axes along the view's x, y, z, e.g. "x -z y"
  Eigen::Vector3d view_rotation =
      Eigen::Vector3d::Zero();  ///< rad, roll pitch yaw (about fixed axes) of the view in `world`

  /// Keys device_axes and view_rotation. Repeated or mirrored axes are an error.
  static FrameMappingConfig read(ConfigReader& reader);
};

/// Rotation between the haptic device's axes and `world`: the hand's right is right in the image.
class FrameMapping {
 public:
  explicit FrameMapping(const FrameMappingConfig& config);

  Eigen::Vector3d toWorld(const Eigen::Vector3d& in_device) const { return rotation_ * in_device; }
  Eigen::Vector3d toDevice(const Eigen::Vector3d& in_world) const { return rotation_.transpose() * in_world; }

 private:
  Eigen::Matrix3d rotation_;  ///< device to `world`
};

}  // namespace microinjection
