#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Polynomial interpolation on [-1, 1]^d from values at a grid of Chebyshev points that has the
/// borders (barycentric formula: Berrut, Trefethen, SIAM Review 46 (2004) 501, eqs. (4.2), (5.4)).
class ChebyshevGrid {
 public:
  /// @param points for each coordinate; 2 or more
  ChebyshevGrid(int dimension, int points);

  int size() const;  ///< number of nodes
  Eigen::VectorXd node(int index) const;
  /// @param values at the nodes
  double interpolate(const Eigen::VectorXd& values, const Eigen::VectorXd& at) const;

 private:
  Eigen::VectorXd weights(double at) const;  ///< of the points of one coordinate; their sum is 1

  int dimension_;
  Eigen::VectorXd points_;  ///< of one coordinate
};

}  // namespace microinjection
