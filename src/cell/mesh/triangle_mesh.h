#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace microinjection {

/// Mesh of linear (P1) triangles of half a section through a body of revolution: coordinates (r, z)
/// in metres, r >= 0 the distance from the axis and exactly 0 on it. Corners of a triangle are
/// counter-clockwise in (r, z).
struct TriangleMesh {
  std::vector<Eigen::Vector2d> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> layers;  ///< of each triangle, 0 the outermost; meshers always fill it
};

/// Signed area of one triangle, m^2.
double triangleArea(const TriangleMesh& mesh, int triangle);

}  // namespace microinjection
