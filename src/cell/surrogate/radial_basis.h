#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Interpolation by radial basis functions r^3 with a linear part. `centres` has a column for each
/// of n points in d dimensions.
///
/// Values of the functions at a point: of each centre, then 1 and the coordinates (n + 1 + d).
Eigen::VectorXd radialBasis(const Eigen::MatrixXd& centres, const Eigen::VectorXd& at);

/// Weights (n + 1 + d rows) of the functions, for each column of `values` (n rows) at the centres.
Eigen::MatrixXd radialWeights(const Eigen::MatrixXd& centres, const Eigen::MatrixXd& values);

}  // namespace microinjection
