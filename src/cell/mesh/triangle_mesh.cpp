#include "cell/mesh/triangle_mesh.h"

namespace microinjection {

double triangleArea(const TriangleMesh& mesh, int triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  const Eigen::Vector2d& a = mesh.vertices[corners[0]];
  const Eigen::Vector2d ab = mesh.vertices[corners[1]] - a, ac = mesh.vertices[corners[2]] - a;
  return (ab.x() * ac.y() - ab.y() * ac.x()) / 2;
}

}  // namespace microinjection
