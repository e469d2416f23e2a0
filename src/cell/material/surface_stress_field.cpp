#include "cell/material/surface_stress_field.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>

#include "cell/material/surface_stress.h"

namespace microinjection {
namespace {

using Triangle = std::array<int, 3>;

SurfacePiece::Edges edgesOf(const std::vector<Eigen::Vector3d>& vertices, const Triangle& triangle) {
  SurfacePiece::Edges edges;
  edges << vertices[triangle[1]] - vertices[triangle[0]], vertices[triangle[2]] - vertices[triangle[0]];
  return edges;
}

double areaOf(const SurfacePiece::Edges& edges) { return edges.col(0).cross(edges.col(1)).norm() / 2; }

int count(const std::vector<bool>& marked, const Triangle& triangle) {
  int result = 0;
  for (const int vertex : triangle) result += marked[vertex] ? 1 : 0;
  return result;
}

}  // namespace

double meanContactPressure(const LoadedSurface& surface, const Eigen::Vector3d& force) {
  double area = 0;
  Eigen::Vector3d outwards = Eigen::Vector3d::Zero();
  for (const Triangle& triangle : surface.triangles) {
    const int touched = count(surface.touched, triangle);
    if (touched == 0) continue;
    const SurfacePiece::Edges edges = edgesOf(surface.deformed, triangle);
    area += touched / 3.0 * areaOf(edges);
    outwards += touched * edges.col(0).cross(edges.col(1));
  }
  return area > 0 ? std::max(0.0, force.dot(outwards.stableNormalized()) / area) : 0;
}

SurfaceStressField surfaceStress(const LoadedSurface& surface, const Material& material, double pressure) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const std::size_t size = surface.rest.size();
  std::vector<double> weights(size, 0);
  SurfaceStressField field;
  field.von_mises.assign(size, 0);
  field.pressure.assign(size, 0);
  field.normal_column.assign(size, Eigen::Vector3d::Zero());
  for (const Triangle& triangle : surface.triangles) {
    if (count(surface.held, triangle) == 3) continue;
    const SurfacePiece piece{edgesOf(surface.rest, triangle), edgesOf(surface.deformed, triangle)};
    const auto F = deformationBehind(piece, material, count(surface.touched, triangle) / 3.0 * pressure);
    if (!F) continue;
    const Eigen::Matrix3d stress = cauchyStress(material, *F);
    const Eigen::Vector3d column = *F * piece.rest.col(0).cross(piece.rest.col(1)).normalized();
    const double weight = areaOf(piece.rest);
    for (const int vertex : triangle) {
      weights[vertex] += weight;
      field.von_mises[vertex] += weight * vonMisesStress(stress);
      field.pressure[vertex] += weight * pressureOf(stress);
      field.normal_column[vertex] += weight * column;
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    const double share = weights[i] > 0 ? 1 / weights[i] : kUnknown;
    field.von_mises[i] *= share;
    field.pressure[i] *= share;
    field.normal_column[i] *= share;
  }
  return field;
}

}  // namespace microinjection
