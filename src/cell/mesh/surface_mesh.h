#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Closed boundary of a tetrahedral mesh. Corners of a triangle are counter-clockwise seen from
/// outside.
struct SurfaceMesh {
  std::vector<Eigen::Vector3d> vertices;       ///< m
  std::vector<std::array<int, 3>> triangles;   ///< indices into `vertices`
  std::vector<std::array<int, 3>> neighbours;  ///< the triangle across the edge from corner i to corner i + 1
  std::vector<int> mesh_vertices;              ///< the TetMesh vertex of each surface vertex, ascending

  Eigen::Vector3d normal(int triangle) const;  ///< outward, of unit length
};

/// The faces that belong to one tetrahedron only. Throws std::invalid_argument when they are not a
/// closed surface (an edge has other than two triangles).
SurfaceMesh extractSurface(const TetMesh& mesh);

}  // namespace microinjection
