#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>

namespace microinjection {

constexpr double kStated95 = 1.96;       // deviations, of a normal distribution
constexpr double kStatedPlane95 = 5.99;  // squared deviations, of one in the plane: chi squared with two degrees

/// Whether an error is within the interval of 95 % that is stated.
/// @param tolerance  standard deviation of the truth
inline bool covers(double error, double deviation, double tolerance = 0) {
  return std::abs(error) <= kStated95 * std::hypot(deviation, tolerance);
}

/// The same for a place, px.
inline bool covers(const cv::Point2d& error, const Eigen::Matrix2d& covariance, double tolerance = 0) {
  const double variance = tolerance * tolerance, xx = covariance(0, 0) + variance, yy = covariance(1, 1) + variance;
  const double xy = covariance(0, 1), determinant = xx * yy - xy * xy;
  if (!(determinant > 0)) return error.x == 0 && error.y == 0;
  const double square = yy * error.x * error.x - 2 * xy * error.x * error.y + xx * error.y * error.y;
  return square <= kStatedPlane95 * determinant;
}

/// px, standard deviation of the distance of a place from the true one along a mean direction.
inline double deviationOf(const Eigen::Matrix2d& covariance) { return std::sqrt(0.5 * covariance.trace()); }

}  // namespace microinjection
