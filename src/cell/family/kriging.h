#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Universal kriging (Gaussian process regression with a linear drift) of functions that are known
/// at points of [-1, 1]^d: the value at another point is a weighted sum of the known ones. The
/// covariance is exp(-|(x - y) / lengths|^2 / 2); see Rasmussen and Williams, "Gaussian Processes
/// for Machine Learning" (2006), 2.7 and 5.4.2.
class Kriging {
 public:
  /// @param points a column each; at least one
  /// @param lengths of the covariance, for each coordinate
  /// @param noise of the known values: its variance over that of the functions
  Kriging(const Eigen::MatrixXd& points, const Eigen::VectorXd& lengths, double noise);

  /// Weight of the value at each point; their sum is 1.
  Eigen::VectorXd weights(const Eigen::VectorXd& at) const;
  /// Standard deviation of the prediction over that of the functions: 0 at known points.
  double deviation(const Eigen::VectorXd& at) const;
  /// Weights (rows) with which all other points predict each point. Nothing is solved anew
  /// (Dubrule, Mathematical Geology 15 (1983) 687).
  Eigen::MatrixXd leaveOneOut() const;

 private:
  Eigen::VectorXd basis(const Eigen::VectorXd& at) const;  ///< covariances, then drift

  Eigen::MatrixXd points_;
  Eigen::VectorXd lengths_;
  Eigen::Index drift_ = 1;  ///< number of functions of the drift
  Eigen::MatrixXd inverse_;
};

}  // namespace microinjection
