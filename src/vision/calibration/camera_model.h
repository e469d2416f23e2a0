#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace microinjection {

/// What a calibration estimates, in the order of its vectors and covariance.
enum CalibrationParameter : int {
  kPixelSize,    ///< m, geometric mean over the axes x and z
  kAngle,        ///< rad, turns the picture counter-clockwise on the screen, after the mirror
  kSkew,         ///< rad, angle from axis x to axis z minus a right angle
  kAxisRatio,    ///< 1, image length of a metre of axis z over that of axis x
  kDepthDriftX,  ///< m/m, by how much axis y moves the tip along x in the image plane
  kDepthDriftZ,  ///< m/m, and along z
  kBacklashX,    ///< m
  kBacklashY,    ///< m
  kBacklashZ,    ///< m
  kTipU,         ///< px, where the tip is seen when it is at the origin
  kTipV,         ///< px
  kFocusX,       ///< m/m, by how much axis x moves the tip's best focus
  kFocusY,       ///< m/m
  kFocusZ,       ///< m/m
  kFocusZero,    ///< m, best focus of the tip at the origin
  kCalibrationParameters
};

template <typename T>
using CalibrationVector = Eigen::Matrix<T, kCalibrationParameters, 1>;

/// Name and unit of a parameter in files and messages.
struct CalibrationParameterName {
  const char* name;
  const char* unit;
};
inline constexpr std::array<CalibrationParameterName, kCalibrationParameters> kCalibrationNames{{
    {"pixel_size", "m"},
    {"angle", "rad"},
    {"skew", "rad"},
    {"axis_ratio", "1"},
    {"depth_drift_x", "m/m"},
    {"depth_drift_z", "m/m"},
    {"backlash_x", "m"},
    {"backlash_y", "m"},
    {"backlash_z", "m"},
    {"tip_u", "px"},
    {"tip_v", "px"},
    {"focus_x", "m/m"},
    {"focus_y", "m/m"},
    {"focus_z", "m/m"},
    {"focus_zero", "m"},
}};

/// Image motion of each manipulator axis, px/m, 2 x 3:
///     J = (1 / s) R diag(mirrored ? -1 : 1, -1) W,  R = [cos, sin; -sin, cos] of the angle.
/// The -1 of the second row turns world z, up, into image y, down. The columns of W are the axes in
/// the image plane (x, z). x and z lie symmetric about the world's axes, half of the skew beside
/// them; their lengths are ratio^(-1/2) and ratio^(1/2).
template <typename T>
Eigen::Matrix<T, 2, 3> imageAxes(const CalibrationVector<T>& p, bool mirrored) {
  using std::cos;
  using std::sin;
  using std::sqrt;
  const T half = T(0.5) * p[kSkew], root = sqrt(p[kAxisRatio]);
  Eigen::Matrix<T, 2, 3> axes;
  axes << cos(half) / root, p[kDepthDriftX], -sin(half) * root,  //
      -sin(half) / root, p[kDepthDriftZ], cos(half) * root;
  axes.row(0) *= T(mirrored ? -1 : 1);
  axes.row(1) *= T(-1);
  Eigen::Matrix<T, 2, 2> rotation;
  rotation << cos(p[kAngle]), sin(p[kAngle]), -sin(p[kAngle]), cos(p[kAngle]);
  return rotation * axes / p[kPixelSize];
}

/// Pixel of a tip at `offset` (m) from the origin.
template <typename T>
Eigen::Matrix<T, 2, 1> tipPixel(const CalibrationVector<T>& p, bool mirrored, const Eigen::Matrix<T, 3, 1>& offset) {
  return p.template segment<2>(kTipU) + imageAxes(p, mirrored) * offset;
}

/// Best focus (m) of a tip at `offset` (m) from the origin.
template <typename T>
T tipFocus(const CalibrationVector<T>& p, const Eigen::Matrix<T, 3, 1>& offset) {
  return p[kFocusZero] + p.template segment<3>(kFocusX).dot(offset);
}

/// Sets pixel size, angle, skew and ratio from the image motion (px/m) of the axes x and z. Returns
/// whether the image is mirrored.
bool setImageAxes(CalibrationVector<double>& p, const Eigen::Vector2d& x, const Eigen::Vector2d& z);

}  // namespace microinjection
