#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "cell/mesh/surface_mesh.h"

namespace microinjection {

/// Volume of the whole mesh, m^3.
inline double meshVolume(const TetMesh& mesh) {
  double volume = 0;
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) volume += tetrahedronVolume(mesh, static_cast<int>(t));
  return volume;
}

/// What flat triangles cut off the ball: over a triangle of area A the cap's height is (rho^2 - s^2) / 2R at distance s
/// from its circumcentre, whose integral is A (a^2 + b^2 + c^2) / 24 R, a, b, c the edges; to first order in (edge /
/// R)^2.
inline double facetingDeficit(const SurfaceMesh& surface, double radius) {
  double deficit = 0;
  for (const std::array<int, 3>& triangle : surface.triangles) {
    const Eigen::Vector3d& a = surface.vertices[triangle[0]];
    const Eigen::Vector3d ab = surface.vertices[triangle[1]] - a, ac = surface.vertices[triangle[2]] - a;
    const double area = ab.cross(ac).norm() / 2;
    deficit += area * (ab.squaredNorm() + ac.squaredNorm() + (ab - ac).squaredNorm()) / (24 * radius);
  }
  return deficit;
}

/// The part of a mesh from a layer inwards.
inline TetMesh fromLayer(const TetMesh& mesh, int layer) {
  TetMesh part;
  part.vertices = mesh.vertices;
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    if (mesh.layers[t] < layer) continue;
    part.tetrahedra.push_back(mesh.tetrahedra[t]);
    part.layers.push_back(mesh.layers[t]);
  }
  return part;
}

/// Vertices of the surface at `radius` from the vertical line through `centre`, by angle.
inline std::vector<int> onCircle(const SurfaceMesh& surface, const Eigen::Vector2d& centre, double radius,
                                 double side) {
  std::vector<std::pair<double, int>> found;
  for (size_t v = 0; v < surface.vertices.size(); ++v) {
    const Eigen::Vector2d from = surface.vertices[v].head<2>() - centre;
    if (surface.vertices[v].z() * side > 0 && std::abs(from.norm() / radius - 1) < 1e-9) {
      found.emplace_back(std::atan2(from.y(), from.x()), static_cast<int>(v));
    }
  }
  std::sort(found.begin(), found.end());
  std::vector<int> vertices;
  for (const auto& entry : found) vertices.push_back(entry.second);
  return vertices;
}

/// Whether edges of the surface join the vertices, each to the next and the last to the first.
inline bool isClosedPolygon(const SurfaceMesh& surface, const std::vector<int>& vertices) {
  std::set<std::pair<int, int>> edges;
  for (const std::array<int, 3>& triangle : surface.triangles) {
    for (int i = 0; i < 3; ++i) edges.emplace(triangle[i], triangle[(i + 1) % 3]);
  }
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (edges.count({vertices[i], vertices[(i + 1) % vertices.size()]}) == 0) return false;
  }
  return vertices.size() > 2;
}

}  // namespace microinjection
