#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace microinjection {

/// Largest difference between `derivative` (rows: outputs, columns: inputs) and central differences
/// of `function` about `point`, relative to the largest entry of either; 0 when both vanish. A
/// correct derivative gives about 1e-8 for `step` = 1e-5 of the scale on which the function
/// changes, a wrong one of order 1. `function` maps an Eigen vector to an Eigen vector.
template <typename Function>
double derivativeError(const Function& function, const Eigen::VectorXd& point, const Eigen::MatrixXd& derivative,
                       double step) {
  Eigen::MatrixXd numeric(derivative.rows(), derivative.cols());
  for (Eigen::Index i = 0; i < derivative.cols(); ++i) {
    Eigen::VectorXd ahead = point, behind = point;
    ahead[i] += step;
    behind[i] -= step;
    numeric.col(i) = (Eigen::VectorXd(function(ahead)) - Eigen::VectorXd(function(behind))) / (2 * step);
  }
  const double scale = std::max(numeric.cwiseAbs().maxCoeff(), derivative.cwiseAbs().maxCoeff());
  return scale > 0 ? (numeric - derivative).cwiseAbs().maxCoeff() / scale : 0;
}

}  // namespace microinjection
