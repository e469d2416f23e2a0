#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>

namespace microinjection {

struct PowerIteration {
  double tolerance = 1e-9;  ///< of the eigenvalue, from one iteration to the next, relative
  int iterations = 3000;    ///< at the most
};

/// Largest eigenvalue of a linear map whose eigenvalues are real and not negative, by power
/// iteration; it converges from below. For M^-1 K its square root is the highest angular frequency,
/// and central differences are stable for steps below 2 over that (damped ones for less).
/// @param map image of a vector of length 1
/// @param start not orthogonal to the eigenvector; a vector of zeros gives 0
double largestEigenvalue(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& map, Eigen::VectorXd start,
                         const PowerIteration& config = {});

/// Highest angular frequency, rad/s, of M^-1 K.
/// @param lower K's lower triangle, N/m, positive semidefinite
/// @param masses M, kg, one for each row, > 0
double largestFrequency(const Eigen::SparseMatrix<double>& lower, const Eigen::VectorXd& masses);

}  // namespace microinjection
