#pragma once

#include <cstddef>

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

}  // namespace microinjection
