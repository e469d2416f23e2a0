#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace microinjection {

/// Tetrahedral mesh of linear (P1) elements, metres. A tetrahedron (a, b, c, d) is positively
/// oriented: (b - a) x (c - a) . (d - a) > 0.
struct TetMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 4>> tetrahedra;
  std::vector<int> layers;  ///< of each tetrahedron, 0 the outermost; meshers always fill it
};

/// Signed volume of one tetrahedron, m^3.
double tetrahedronVolume(const TetMesh& mesh, int tetrahedron);

/// Shape quality of one tetrahedron: three times the radius of its inscribed sphere over the radius
/// of its circumscribed sphere; 1 for the regular tetrahedron, 0 for a flat one, negative for an
/// inverted one.
double radiusRatio(const TetMesh& mesh, int tetrahedron);

/// Smallest radiusRatio of the mesh.
double worstRadiusRatio(const TetMesh& mesh);

}  // namespace microinjection
