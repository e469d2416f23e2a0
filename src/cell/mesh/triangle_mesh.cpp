#include "cell/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

double triangleArea(const TriangleMesh& mesh, int triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  const Eigen::Vector2d& a = mesh.vertices[corners[0]];
  return cross(mesh.vertices[corners[1]] - a, mesh.vertices[corners[2]] - a) / 2;
}

double sweptVolume(const TriangleMesh& mesh, int triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  const double r = (mesh.vertices[corners[0]] + mesh.vertices[corners[1]] + mesh.vertices[corners[2]]).x() / 3;
  return 2 * M_PI * r * triangleArea(mesh, triangle);
}

double smallestAngle(const TriangleMesh& mesh, int triangle) {
  const std::array<int, 3>& corners = mesh.triangles[triangle];
  double smallest = std::acos(-1.0);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector2d& at = mesh.vertices[corners[i]];
    const Eigen::Vector2d to = mesh.vertices[corners[(i + 1) % 3]] - at;
    const Eigen::Vector2d from = mesh.vertices[corners[(i + 2) % 3]] - at;
    smallest = std::min(smallest, std::atan2(std::abs(cross(to, from)), to.dot(from)));
  }
  return smallest;
}

}  // namespace microinjection
