#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Solves regressors * solution = observed with the least sum of the rows' distances (of absolute
/// values for one column), by iteratively reweighted least squares. A few outliers hardly move it.
/// Empty when the regressors are dependent.
Eigen::MatrixXd leastDistances(const Eigen::MatrixXd& regressors, const Eigen::MatrixXd& observed, int iterations);

}  // namespace microinjection
