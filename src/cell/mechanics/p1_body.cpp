#include "cell/mechanics/p1_body.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <string>

namespace microinjection {
namespace {

/// Ratio of a volume to the cube of the longest edge below which a tetrahedron is flat. Its force
/// would be rounding error.
constexpr double kFlat = 1e-12;

void checkTetrahedron(const TetMesh& mesh, std::size_t tetrahedron) {
  const auto name = [&] { return "tetrahedron " + std::to_string(tetrahedron); };
  const int count = static_cast<int>(mesh.vertices.size());
  for (int vertex : mesh.tetrahedra[tetrahedron]) {
    if (vertex < 0 || vertex >= count) {
      throw std::invalid_argument(name() + " names vertex " + std::to_string(vertex) + ", but there are " +
                                  std::to_string(count));
    }
    if (!mesh.vertices[vertex].allFinite()) {
      throw std::invalid_argument(name() + ": vertex " + std::to_string(vertex) + " is not finite");
    }
  }
  const Eigen::Matrix3d edge = tetrahedronEdges(mesh, tetrahedron);
  const double determinant = edge.col(0).cross(edge.col(1)).dot(edge.col(2));
  if (!(determinant > kFlat * std::pow(edge.colwise().norm().maxCoeff(), 3))) {
    throw std::invalid_argument(name() + (determinant < 0 ? " is inverted" : " is flat"));
  }
}

}  // namespace

Eigen::Matrix3d tetrahedronEdges(const TetMesh& mesh, std::size_t tetrahedron) {
  const auto& corner = mesh.tetrahedra[tetrahedron];
  Eigen::Matrix3d result;
  for (int a = 0; a < 3; ++a) result.col(a) = mesh.vertices[corner[a + 1]] - mesh.vertices[corner[0]];
  return result;
}

Eigen::Matrix<double, 3, 4> shapeGradients(const TetMesh& mesh, std::size_t tetrahedron) {
  Eigen::Matrix<double, 3, 4> gradients;
  gradients.rightCols<3>() = tetrahedronEdges(mesh, tetrahedron).inverse().transpose();
  gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
  return gradients;
}

void checkP1Body(const TetMesh& mesh, const Lame& lame) {
  if (!(lame.mu > 0 && 3 * lame.lambda + 2 * lame.mu > 0 && std::isfinite(lame.mu + lame.lambda))) {
    throw std::invalid_argument("lambda = " + std::to_string(lame.lambda) + " Pa, mu = " + std::to_string(lame.mu) +
                                " Pa: must be mu > 0 and 3 lambda + 2 mu > 0");
  }
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) checkTetrahedron(mesh, t);
}

}  // namespace microinjection
