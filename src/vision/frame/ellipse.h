#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace microinjection {

/// Angle between two directions, 0 to pi (rad).
inline double angleBetween(double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); }

/// An ellipse in the image (px, rad). semi_axes: longer, shorter; angle of the longer from x towards y.
struct Ellipse {
  cv::Point2d centre;
  Eigen::Vector2d semi_axes{0, 0};
  double angle = 0;

  double meanDiameter() const;  ///< of the circle of the same area, px
  /// The ellipse's point at parameter `t` (rad), t = 0 at the end of the longer axis.
  cv::Point2d at(double t) const;
  /// Distance (px) from the centre to the border in direction `direction` (rad, from x towards y).
  double radius(double direction) const;
  /// The same from another point inside of the ellipse; 0 when `from` is outside.
  double reach(const cv::Point2d& from, double direction) const;
  /// Distance (px, of either sign) from a point along a direction to where that line leaves the ellipse;
  /// none: the line misses it.
  std::optional<double> exit(const cv::Point2d& from, double direction) const;
  /// Signed distance (px, first order) of a point: positive outside.
  double distance(const cv::Point2d& point) const;
};

struct EllipseFit {
  bool valid = false;
  Ellipse ellipse;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of centre x, centre y, mean diameter, px^2
  double residual = 0;                                   ///< px, root mean square of the inliers
  std::vector<bool> inlier;                              ///< of each point
};

/// Fits an ellipse to points (in order along the border) by least squares of the distance with
/// Tukey's weights, starting from the circle `start`. An inlier is within `tolerance` (px), or 3
/// residuals where these are more. The covariance counts neighbours that deviate together once.
/// @param circle  true: both axes are equal
EllipseFit fitEllipse(const std::vector<cv::Point2d>& points, const Ellipse& start, double tolerance,
                      bool circle = false);

}  // namespace microinjection
