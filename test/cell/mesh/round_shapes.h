#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "cell/mesh/tet_mesh.h"
#include "cell/mesh/triangle_mesh.h"

namespace microinjection {

/// Sphere of radius 1: an octahedron whose triangles are halved in all edges `level` times and put on the sphere;
/// counter-clockwise seen from outside.
inline void octahedralSphere(int level, std::vector<Eigen::Vector3d>& vertices,
                             std::vector<std::array<int, 3>>& triangles) {
  vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int i = 0; i < level; ++i) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [entry, added] = middles.try_emplace(std::minmax(a, b), static_cast<int>(vertices.size()));
      if (added) vertices.push_back((vertices[a] + vertices[b]).normalized());
      return entry->second;
    };
    std::vector<std::array<int, 3>> halved;
    for (const auto& [a, b, c] : triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      halved.insert(halved.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = halved;
  }
}

/// Ball of concentric layers about the origin with outer radii `radii`, outermost first: the innermost layer is of
/// cones from the origin, others are of prisms, three tetrahedra each.
inline TetMesh layeredBall(int level, const std::vector<double>& radii) {
  TetMesh mesh;
  std::vector<Eigen::Vector3d> sphere;
  std::vector<std::array<int, 3>> triangles;
  octahedralSphere(level, sphere, triangles);
  const int layers = static_cast<int>(radii.size()), count = static_cast<int>(sphere.size());
  for (double radius : radii) {
    for (const Eigen::Vector3d& x : sphere) mesh.vertices.push_back(radius * x);
  }
  mesh.vertices.push_back(Eigen::Vector3d::Zero());
  const auto add = [&mesh](std::array<int, 4> tetrahedron, int layer) {
    mesh.tetrahedra.push_back(tetrahedron);
    mesh.layers.push_back(layer);
    const int last = static_cast<int>(mesh.tetrahedra.size()) - 1;
    auto& t = mesh.tetrahedra[last];
    if (tetrahedronVolume(mesh, last) < 0) std::swap(t[0], t[1]);
    // Every corner comes first in turn, as from a mesher.
    for (int i = 0; i < last % 4; ++i)
      t = i == 1 ? std::array<int, 4>{t[3], t[2], t[1], t[0]} : std::array<int, 4>{t[1], t[0], t[3], t[2]};
  };
  for (std::array<int, 3> corners : triangles) {
    std::sort(corners.begin(), corners.end());  // neighbours then cut their common side alike
    for (int layer = 0; layer < layers; ++layer) {
      const int outer = layer * count, inner = outer + count;
      const auto [a, b, c] = corners;
      if (layer == layers - 1) {
        add({inner, outer + a, outer + b, outer + c}, layer);
      } else {
        add({inner + a, inner + b, inner + c, outer + c}, layer);
        add({inner + a, inner + b, outer + b, outer + c}, layer);
        add({inner + a, outer + a, outer + b, outer + c}, layer);
      }
    }
  }
  return mesh;
}

/// Section of such a ball: `arcs` pieces of each half circle, from -z to +z.
inline TriangleMesh layeredHalfDisc(int arcs, const std::vector<double>& radii) {
  TriangleMesh mesh;
  const int layers = static_cast<int>(radii.size());
  for (double radius : radii) {
    for (int i = 0; i <= arcs; ++i) {
      const double angle = 3.14159265358979323846 * i / arcs;
      const bool pole = i == 0 || i == arcs;
      mesh.vertices.emplace_back(pole ? 0 : radius * std::sin(angle), -radius * std::cos(angle));
    }
  }
  mesh.vertices.emplace_back(0, 0);
  for (int layer = 0; layer < layers; ++layer) {
    for (int i = 0; i < arcs; ++i) {
      const int a = layer * (arcs + 1) + i, inner = a + arcs + 1;
      if (layer == layers - 1) {
        mesh.triangles.push_back({static_cast<int>(mesh.vertices.size()) - 1, a, a + 1});
        mesh.layers.push_back(layer);
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{inner, a, a + 1}, {inner, a + 1, inner + 1}});
        mesh.layers.insert(mesh.layers.end(), {layer, layer});
      }
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    auto& triangle = mesh.triangles[i];
    std::rotate(triangle.begin(), triangle.begin() + i % 3, triangle.end());
  }
  return mesh;
}

}  // namespace microinjection
