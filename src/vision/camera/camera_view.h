#pragma once

#include <Eigen/Core>

#include "base/config_reader.h"

namespace microinjection {

/// Maps the world's plane (x, z) (m) to the pixels of an image, and back.
///
/// The microscope looks along the world's +y. Pixels have their origin at the centre of the
/// top-left pixel, x to the right and y down. Without rotation and mirror the world's x is to the
/// right and its z is up. The mirror swaps left and right; the rotation follows it and turns the
/// picture counter-clockwise as seen on the screen.
struct CameraView {
  int width = 1392;             ///< px
  int height = 1040;            ///< px
  double pixel_size = 0.25e-6;  ///< m, of the specimen
  double angle = 0;             ///< rad
  bool mirrored = false;
  Eigen::Vector2d origin{695.5, 519.5};  ///< px, where the world's origin is seen; may lie outside the image

  /// Reads width, height, pixel_size, angle, mirrored and origin; the default origin is the centre
  /// of the image.
  static CameraView read(ConfigReader& reader);
  /// Throws ConfigError with all errors of the members.
  void validate() const;

  Eigen::Vector2d pixelOf(const Eigen::Vector2d& world) const;  ///< px, of (x, z) in m
  Eigen::Vector2d worldOf(const Eigen::Vector2d& pixel) const;  ///< (x, z) in m, of px
  /// d pixel / d world (px/m). Its determinant is negative unless the view is mirrored, because the
  /// image's y points down.
  Eigen::Matrix2d pixelsPerMetre() const;
  /// Unit vector in the image of a direction (x, z) of any length but zero.
  Eigen::Vector2d imageDirection(const Eigen::Vector2d& world) const;
  /// Whether the image has the pixel.
  bool contains(const Eigen::Vector2d& pixel) const;
};

}  // namespace microinjection
