#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

/// Nodes of a mesh's outermost surface, ascending.
std::vector<int> outerNodes(const QuadraticMesh<3>& mesh);

/// The outermost surface in triangles, four for each facet, counter-clockwise seen from outside;
/// indices into outerNodes().
std::vector<Eigen::Vector3i> outerTriangles(const QuadraticMesh<3>& mesh);

}  // namespace microinjection
