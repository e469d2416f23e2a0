#pragma once

#include <Eigen/Core>

namespace microinjection {

/// The point of a sphere about the origin on the vertical line through `xy`, on the upper (side =
/// +1) or lower (-1) half. @pre |xy| <= radius
Eigen::Vector3d pointOnSphere(const Eigen::Vector2d& xy, double side, double radius);

/// The closed curve on a sphere about the origin at distance `radius` from a vertical line; a
/// circle when the line passes through the sphere's centre. Any unit of length.
class CircleOnSphere {
 public:
  /// @pre |centre| + radius < sphere_radius, so that the curve stays on its half
  CircleOnSphere(const Eigen::Vector2d& centre, double radius, double side, double sphere_radius);

  const Eigen::Vector2d& centre() const { return centre_; }
  double radius() const { return radius_; }
  double side() const { return side_; }

  /// The point of the curve in the same direction from the vertical line.
  Eigen::Vector3d project(const Eigen::Vector3d& point) const;

  /// Distance of a point from the curve, which is approximated by a polygon: at most 1e-3 of the
  /// radius too large. It is fast because meshers call it a million times.
  double distance(const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector2d centre_;
  double radius_, side_, sphere_radius_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> corners_;  // a column for each coordinate
};

}  // namespace microinjection
