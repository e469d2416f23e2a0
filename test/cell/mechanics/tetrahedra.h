#pragma once

#include <algorithm>
#include <vector>

#include "cell/mechanics/bodies.h"
#include "cell/mesh/quadratic_mesh.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// The linear mesh that a second-order one was made from.
inline TetMesh linearMesh(const QuadraticMesh<3>& quadratic) {
  TetMesh mesh;
  mesh.vertices.assign(quadratic.nodes.begin(), quadratic.nodes.begin() + quadratic.vertex_count);
  for (const auto& nodes : quadratic.elements) {
    mesh.tetrahedra.emplace_back();
    std::copy_n(nodes.begin(), 4, mesh.tetrahedra.back().begin());
  }
  mesh.layers = quadratic.layers;
  return mesh;
}

/// Young's modulus (Pa) and Poisson's ratio of the forces that are compared.
constexpr double kYoung = 2, kPoisson = 0.45;

constexpr double kDensity = 3;  // kg/m^3

/// 162 elements: the last block of eight is not full.
inline TetMesh irregularMesh() { return linearMesh(irregularBlock<3>(3)); }

/// Places of the vertices, xyz per vertex.
inline Eigen::VectorXd places(const TetMesh& mesh) {
  Eigen::VectorXd result(3 * static_cast<Eigen::Index>(mesh.vertices.size()));
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) result.segment<3>(3 * v) = mesh.vertices[v];
  return result;
}

}  // namespace microinjection
