#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstddef>
#include <functional>

#include "cell/material/lame.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Highest angular frequency of one free, undeformed P1 tetrahedron with lumped mass (a quarter to
/// each vertex), rad/s. In closed form: with the principal values c_i >= c_j >= c_k of sum_a g_a
/// g_a^T (g: gradients of the shape functions, 1/m), density w^2 / 4 is the largest of mu (c_i +
/// c_j), a shear, and of the eigenvalues of 2 mu diag(c) + lambda sqrt(c) sqrt(c)^T, a change of
/// volume.
double elementFrequency(const TetMesh& mesh, std::size_t tetrahedron, const Lame& lame, double density);

/// Upper bound of the angular frequencies of the body under any constraints, rad/s: the highest
/// frequency of its elements (Irons and Treharne, "A bound theorem in eigenvalues and its practical
/// applications", 1971). Central differences with lumped mass are stable about the undeformed state
/// for time steps below 2 over it. `density` in kg/m^3. @pre the mesh passes checkP1Body
double frequencyBound(const TetMesh& mesh, const Lame& lame, double density);

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
