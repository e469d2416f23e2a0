#include "operation/display/cell_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "operation/display/colour_map.h"
#include "operation/display/quadratic_facets.h"

namespace microinjection {
namespace {

bool indicesFit(const std::vector<int>& indices, std::size_t size) {
  return std::all_of(indices.begin(), indices.end(),
                     [size](int index) { return index >= 0 && static_cast<std::size_t>(index) < size; });
}

/// Sums of the triangles' normals at each vertex (1/m^2), weighted after N. Max, Weights for computing vertex normals
/// from facet normals, Journal of Graphics Tools 4(2), 1999: exact where the vertices around it lie on a sphere.
std::vector<Eigen::Vector3d> spheresNormals(const std::vector<Eigen::Vector3d>& vertices,
                                            const std::vector<std::array<int, 3>>& triangles) {
  std::vector<Eigen::Vector3d> normals(vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& triangle : triangles) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& at = vertices[triangle[k]];
      const Eigen::Vector3d to_next = vertices[triangle[(k + 1) % 3]] - at,
                            to_last = vertices[triangle[(k + 2) % 3]] - at;
      const double lengths = to_next.squaredNorm() * to_last.squaredNorm();
      if (lengths > 0) normals[triangle[k]] += to_next.cross(to_last) / lengths;
    }
  }
  return normals;
}

}  // namespace

std::string CellSurface::defect() const {
  const std::size_t size = vertices.size();
  if (size == 0 || triangles.empty()) return "surface is empty";
  if (displacement.size() != size) return "displacement has another length than vertices";
  if (!at_rest.empty() && at_rest.size() != size) return "rest_vertices has another length than vertices";
  for (const auto& triangle : triangles) {
    if (!indicesFit({triangle.begin(), triangle.end()}, size)) return "triangles name a vertex that is not there";
  }
  if (!indicesFit(contact_vertices, size)) return "contact_vertices name a vertex that is not there";
  if (!indicesFit(held_vertices, size)) return "held_vertices name a vertex that is not there";
  for (std::size_t i = 0; i < size; ++i) {
    if (!vertices[i].allFinite() || !std::isfinite(displacement[i])) return "surface is not finite";
    if (!at_rest.empty() && !at_rest[i].allFinite()) return "surface at rest is not finite";
  }
  return "";
}

std::vector<Eigen::Vector3d> vertexNormals(const CellSurface& surface) {
  const std::vector<QuadraticFacet> facets = quadraticFacets(surface.triangles);
  std::vector<Eigen::Vector3d> normals =
      facets.empty() ? spheresNormals(surface.vertices, surface.triangles) : quadraticNormals(surface.vertices, facets);
  // stableNormalize, because the facets' areas of square micrometres are below the threshold of normalize.
  for (Eigen::Vector3d& normal : normals) normal.stableNormalize();
  return normals;
}

TriangleSoup colouredSurface(const CellSurface& surface, const std::vector<double>& values, const ColourScale& scale,
                             double enlargement) {
  const std::vector<Eigen::Vector3d> normals = vertexNormals(surface);
  TriangleSoup soup;
  soup.points.reserve(3 * surface.triangles.size());
  soup.colours.reserve(3 * surface.triangles.size());
  for (const auto& triangle : surface.triangles) {
    for (const int vertex : triangle) {
      soup.points.push_back(toDisplay(surface.vertices[vertex], enlargement));
      soup.colours.push_back(shaded(scale.colour(values[vertex]), lampLight(normals[vertex])));
    }
  }
  return soup;
}

LineList edges(const CellSurface& surface, double lift, double enlargement) {
  const std::vector<Eigen::Vector3d> normals = vertexNormals(surface);
  const auto lifted = [&](int vertex) -> Eigen::Vector3d {
    return toDisplay(surface.vertices[vertex], enlargement) + lift * normals[vertex];
  };
  std::set<std::pair<int, int>> unique;
  for (const auto& [a, b, c] : surface.triangles) {
    for (const auto& edge : {std::minmax({a, b}), std::minmax({b, c}), std::minmax({c, a})}) unique.insert(edge);
  }
  LineList lines;
  lines.reserve(2 * unique.size());
  for (const auto& [a, b] : unique) {
    lines.push_back(lifted(a));
    lines.push_back(lifted(b));
  }
  return lines;
}

std::vector<Eigen::Vector3d> pointsAt(const CellSurface& surface, const std::vector<int>& vertices,
                                      double enlargement) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(vertices.size());
  for (const int vertex : vertices) points.push_back(toDisplay(surface.vertices[vertex], enlargement));
  return points;
}

}  // namespace microinjection
