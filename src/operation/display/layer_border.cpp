#include "operation/display/layer_border.h"

#include <algorithm>
#include <cstddef>

namespace microinjection {

bool LayerBorder::drawable() const {
  const int size = static_cast<int>(vertices.size());
  const auto fits = [size](const std::array<int, 3>& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [size](int vertex) { return vertex >= 0 && vertex < size; });
  };
  return layer > 0 && !triangles.empty() && std::all_of(triangles.begin(), triangles.end(), fits) &&
         std::all_of(vertices.begin(), vertices.end(), [](const auto& vertex) { return vertex.allFinite(); });
}

LayerBorder borderBelow(const CellSurface& surface, const std::vector<Eigen::Vector3d>& columns, double thickness) {
  CellSurface rest = surface;
  rest.vertices = surface.at_rest;
  const std::vector<Eigen::Vector3d> normals = vertexNormals(rest);
  LayerBorder border;
  border.triangles = surface.triangles;
  border.estimated = true;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    const Eigen::Vector3d& column = columns[i].allFinite() ? columns[i] : normals[i];
    border.vertices.emplace_back(surface.vertices[i] - thickness * column);
  }
  return border;
}

LayerBorder borderAtRest(const CellSurface& surface, int layer, double share, const Eigen::Vector3d& centre) {
  LayerBorder border;
  border.layer = layer;
  border.triangles = surface.triangles;
  border.estimated = true;
  for (const Eigen::Vector3d& vertex : surface.at_rest)
    border.vertices.emplace_back(centre + share * (vertex - centre));
  return border;
}

}  // namespace microinjection
