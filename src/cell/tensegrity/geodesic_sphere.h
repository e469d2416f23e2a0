#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace microinjection {

/// Triangles on a sphere about the origin, corners counter-clockwise seen from outside.
struct GeodesicSphere {
  std::vector<Eigen::Vector3d> vertices;  ///< m, the given corners first
  std::vector<std::array<int, 3>> triangles;

  /// Divides each of the `faces` of a convex polyhedron, whose corners lie on the sphere, into
  /// divisions^2 triangles and projects their vertices onto the sphere: 12 corners and 20 faces
  /// give 10 divisions^2 + 2 vertices.
  GeodesicSphere(const std::vector<Eigen::Vector3d>& corners, const std::vector<std::array<int, 3>>& faces,
                 int divisions);
};

}  // namespace microinjection
