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

/// The outer surface of one layer, 0 outermost: a border between two layers, or the outermost
/// surface.
struct LayerSurface {
  std::vector<int> nodes;                  ///< of the mesh, ascending
  std::vector<Eigen::Vector3i> triangles;  ///< as outerTriangles(); indices into `nodes`
};
LayerSurface layerSurface(const QuadraticMesh<3>& mesh, int layer);

}  // namespace microinjection
