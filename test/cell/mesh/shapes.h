#pragma once

#include <array>
#include <utility>

#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// The unit cube [0, 1]^3 in n^3 cubes of six tetrahedra each (Kuhn's), positively oriented.
inline TetMesh unitCube(int n) {
  TetMesh mesh;
  const auto vertex = [n](int i, int j, int k) { return i + (n + 1) * (j + (n + 1) * k); };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(i / double(n), j / double(n), k / double(n));
    }
  }
  // Each permutation of the axes is a way from corner (0, 0, 0) to (1, 1, 1); odd ones are turned.
  const int ways[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int cube = 0; cube < n * n * n; ++cube) {
    const int at[3] = {cube % n, cube / n % n, cube / (n * n)};
    for (int way = 0; way < 6; ++way) {
      int corner[3] = {at[0], at[1], at[2]};
      std::array<int, 4> tetrahedron = {vertex(corner[0], corner[1], corner[2]), 0, 0, 0};
      for (int step = 0; step < 3; ++step) {
        ++corner[ways[way][step]];
        tetrahedron[step + 1] = vertex(corner[0], corner[1], corner[2]);
      }
      if (way >= 3) std::swap(tetrahedron[1], tetrahedron[2]);
      mesh.tetrahedra.push_back(tetrahedron);
    }
  }
  return mesh;
}

}  // namespace microinjection
