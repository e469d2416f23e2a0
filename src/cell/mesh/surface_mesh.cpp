#include "cell/mesh/surface_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

namespace microinjection {
namespace {

using Triangle = std::array<int, 3>;

/// Faces of a positively oriented tetrahedron, counter-clockwise seen from outside.
constexpr int kFaces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

std::vector<Triangle> boundaryTriangles(const TetMesh& mesh) {
  std::map<Triangle, std::pair<int, Triangle>> faces;  // by sorted corners: number of tetrahedra, oriented corners
  for (const std::array<int, 4>& tetrahedron : mesh.tetrahedra) {
    for (const int* face : kFaces) {
      const Triangle oriented = {tetrahedron[face[0]], tetrahedron[face[1]], tetrahedron[face[2]]};
      Triangle key = oriented;
      std::sort(key.begin(), key.end());
      auto& entry = faces[key];
      ++entry.first;
      entry.second = oriented;
    }
  }
  std::vector<Triangle> boundary;
  for (const auto& face : faces) {
    if (face.second.first == 1) boundary.push_back(face.second.second);
  }
  return boundary;
}

std::vector<Triangle> findNeighbours(const std::vector<Triangle>& triangles) {
  std::map<std::pair<int, int>, int> owner;  // of each directed edge
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const bool is_new = owner.emplace(std::pair(triangles[t][i], triangles[t][(i + 1) % 3]), t).second;
      if (!is_new) throw std::invalid_argument("the boundary of the mesh is not a surface: an edge has many triangles");
    }
  }
  std::vector<Triangle> neighbours(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto across = owner.find({triangles[t][(i + 1) % 3], triangles[t][i]});
      if (across == owner.end()) throw std::invalid_argument("the boundary of the mesh is not a closed surface");
      neighbours[t][i] = across->second;
    }
  }
  return neighbours;
}

}  // namespace

Eigen::Vector3d SurfaceMesh::normal(int triangle) const {
  const std::array<int, 3>& corners = triangles[triangle];
  const Eigen::Vector3d& a = vertices[corners[0]];
  return (vertices[corners[1]] - a).cross(vertices[corners[2]] - a).normalized();
}

SurfaceMesh extractSurface(const TetMesh& mesh) {
  SurfaceMesh surface;
  surface.triangles = boundaryTriangles(mesh);
  surface.neighbours = findNeighbours(surface.triangles);
  std::vector<int> surface_vertex(mesh.vertices.size(), -1);
  for (const Triangle& triangle : surface.triangles) {
    for (int corner : triangle) surface_vertex[corner] = 0;
  }
  for (size_t v = 0; v < surface_vertex.size(); ++v) {
    if (surface_vertex[v] < 0) continue;
    surface_vertex[v] = static_cast<int>(surface.vertices.size());
    surface.vertices.push_back(mesh.vertices[v]);
    surface.mesh_vertices.push_back(static_cast<int>(v));
  }
  for (Triangle& triangle : surface.triangles) {
    for (int& corner : triangle) corner = surface_vertex[corner];
  }
  return surface;
}

}  // namespace microinjection
