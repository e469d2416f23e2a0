#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "cell/material/lame.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Of a tetrahedron: from its first vertex to the others, in the columns, m.
Eigen::Matrix3d tetrahedronEdges(const TetMesh& mesh, std::size_t tetrahedron);

/// Gradients of a P1 tetrahedron's four shape functions, in the columns, 1/m.
Eigen::Matrix<double, 3, 4> shapeGradients(const TetMesh& mesh, std::size_t tetrahedron);

/// Throws std::invalid_argument for a mesh with a vertex that is not finite or a tetrahedron that names a vertex that
/// is not there, is flat or is inverted, or moduli that are not mu > 0 and 3 lambda + 2 mu > 0.
void checkP1Body(const TetMesh& mesh, const Lame& lame);

}  // namespace microinjection
