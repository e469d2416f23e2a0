#include "operation/display/quadratic_facets.h"

#include <Eigen/Geometry>
#include <cstddef>

namespace microinjection {
namespace {

/// Derivatives of the six shape functions along x and y of the reference triangle (0, 0), (1, 0), (0, 1).
using Gradients = Eigen::Matrix<double, 6, 2>;

Gradients gradientsAt(double x, double y) {
  const double z = 1 - x - y;
  Gradients g;
  g << 1 - 4 * z, 1 - 4 * z,  // corner 0
      4 * x - 1, 0,           // corner 1
      0, 4 * y - 1,           // corner 2
      4 * (z - x), -4 * x,    // middle of 01
      4 * y, 4 * x,           // middle of 12
      -4 * y, 4 * (z - y);    // middle of 20
  return g;
}

/// At the nodes, in their order.
const std::array<Gradients, 6>& nodeGradients() {
  static const std::array<Gradients, 6> gradients = {gradientsAt(0, 0),   gradientsAt(1, 0),     gradientsAt(0, 1),
                                                     gradientsAt(0.5, 0), gradientsAt(0.5, 0.5), gradientsAt(0, 0.5)};
  return gradients;
}

}  // namespace

std::vector<QuadraticFacet> quadraticFacets(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<QuadraticFacet> facets;
  if (triangles.size() % 4 != 0) return {};
  for (std::size_t i = 0; i < triangles.size(); i += 4) {
    const auto &first = triangles[i], &second = triangles[i + 1], &third = triangles[i + 2], &middle = triangles[i + 3];
    const int m01 = middle[0], m12 = middle[1], m20 = middle[2];
    const bool fits = first[1] == m01 && first[2] == m20 && second[0] == m01 && second[2] == m12 && third[0] == m20 &&
                      third[1] == m12;
    if (!fits) return {};
    facets.push_back({first[0], second[1], third[2], m01, m12, m20});
  }
  return facets;
}

std::vector<Eigen::Vector3d> quadraticNormals(const std::vector<Eigen::Vector3d>& vertices,
                                              const std::vector<QuadraticFacet>& facets) {
  std::vector<Eigen::Vector3d> normals(vertices.size(), Eigen::Vector3d::Zero());
  for (const QuadraticFacet& facet : facets) {
    Eigen::Matrix<double, 3, 6> nodes;
    for (int i = 0; i < 6; ++i) nodes.col(i) = vertices[facet[i]];
    for (int i = 0; i < 6; ++i) {
      const Eigen::Matrix<double, 3, 2> tangents = nodes * nodeGradients()[i];
      normals[facet[i]] += tangents.col(0).cross(tangents.col(1));
    }
  }
  return normals;
}

}  // namespace microinjection
