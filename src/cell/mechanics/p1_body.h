#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "cell/material/lame.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Edges of a tetrahedron from its first vertex to the others, in the columns, m.
Eigen::Matrix3d tetrahedronEdges(const TetMesh& mesh, std::size_t tetrahedron);

/// Gradients of a P1 tetrahedron's four shape functions, in the columns, 1/m.
Eigen::Matrix<double, 3, 4> shapeGradients(const TetMesh& mesh, std::size_t tetrahedron);

/// Throws std::invalid_argument when a vertex is not finite, when a tetrahedron is flat, inverted
/// or has a vertex that does not exist, or unless mu > 0 and 3 lambda + 2 mu > 0.
void checkP1Body(const TetMesh& mesh, const Lame& lame);

}  // namespace microinjection
