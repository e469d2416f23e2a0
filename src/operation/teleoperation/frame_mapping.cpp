#include "operation/teleoperation/frame_mapping.h"

#include <Eigen/Geometry>
#include <cmath>
#include <sstream>

namespace microinjection {
namespace {

constexpr char kAllowed[] = "three of x, y, z with or without -, each once and right-handed, e.g. \"x -z y\"";

/// Row i is the device's axis along the view's axis i. Returns zero when the text is not three
/// axes.
Eigen::Matrix3d toMatrix(const std::string& axes) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  std::istringstream in(axes);
  int row = 0;
  for (std::string name; in >> name; ++row) {
    const bool minus = name[0] == '-';
    const std::string letter = minus ? name.substr(1) : name;
    if (row == 3 || letter.size() != 1 || letter[0] < 'x' || letter[0] > 'z') return Eigen::Matrix3d::Zero();
    matrix(row, letter[0] - 'x') = minus ? -1 : 1;
  }
  return matrix;
}

bool isRotation(const Eigen::Matrix3d& matrix) {
  return (matrix * matrix.transpose()).isIdentity(1e-12) && std::abs(matrix.determinant() - 1) < 1e-12;
}

}  // namespace

FrameMappingConfig FrameMappingConfig::read(ConfigReader& reader) {
  FrameMappingConfig config;
  reader.text("device_axes", config.device_axes);
  if (!isRotation(toMatrix(config.device_axes))) reader.error("device_axes", std::string("must be ") + kAllowed);
  reader.vector("view_rotation", config.view_rotation, Range::closed(-6.3, 6.3));
  return config;
}

FrameMapping::FrameMapping(const FrameMappingConfig& config) {
  const Eigen::Matrix3d axes = toMatrix(config.device_axes);
  const Eigen::Vector3d& angle = config.view_rotation;
  const Eigen::Quaterniond view = Eigen::AngleAxisd(angle.z(), Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(angle.y(), Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(angle.x(), Eigen::Vector3d::UnitX());
  // Without a view rotation the axes are exact: no rounding in the hand's position.
  rotation_ = angle.isZero(0) ? axes : Eigen::Matrix3d(view.toRotationMatrix() * axes);
}

}  // namespace microinjection
