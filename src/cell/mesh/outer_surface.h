#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

/// Nodes of a mesh's outermost surface, ascending.
std::vector<int> outerNodes(const QuadraticMesh<3>& mesh);

/// That surface in triangles, each facet cut into four, counter-clockwise seen from outside; indices into outerNodes().
std::vector<Eigen::Vector3i> outerTriangles(const QuadraticMesh<3>& mesh);

}  // namespace microinjection
