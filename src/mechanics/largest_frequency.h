#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace microinjection {

/// Highest angular frequency, rad/s, of M^-1 K by power iteration, from below; central differences are stable for steps
/// below 2 over it (their damped form for less).
/// @param lower K's lower triangle, N/m, positive semidefinite @param masses M, kg, one for each row, > 0.
double largestFrequency(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses);

}  // namespace microinjection
