#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "operation/display/display_scale.h"
#include "operation/display/surface_quantity.h"
#include "operation/display/triangle_soup.h"

namespace microinjection {

/// The cell's deformed surface as the simulator reports it.
struct CellSurface {
  std::vector<Eigen::Vector3d> vertices;      ///< m
  std::vector<Eigen::Vector3d> at_rest;       ///< m, the same vertices without a needle; empty: not known
  std::vector<std::array<int, 3>> triangles;  ///< counterclockwise as seen from outside
  std::vector<double> displacement;           ///< m, magnitude at each vertex
  std::vector<int> contact_vertices;
  std::vector<int> held_vertices;

  /// Empty when the surface can be drawn, otherwise the reason: not finite, or a wrong index or
  /// length.
  std::string defect() const;
};

/// Outward unit normals at the vertices; zero at a vertex without triangles. They are those of the curved facets of
/// second order where the surface is made of them (quadraticFacets()), else of the sphere through the neighbours.
std::vector<Eigen::Vector3d> vertexNormals(const CellSurface& surface);

/// The surface coloured by a value at each vertex, in display units. The colours include light from
/// above the viewer, because rviz does not light triangles with individual colours.
/// @param values  SI, of the scale's quantity
TriangleSoup colouredSurface(const CellSurface& surface, const std::vector<double>& values, const ColourScale& scale,
                             double enlargement = kDisplayScale);

/// Each edge once, lifted off the surface by `lift` (display units) to stay visible.
LineList edges(const CellSurface& surface, double lift, double enlargement = kDisplayScale);

/// The points at `vertices`, display units.
std::vector<Eigen::Vector3d> pointsAt(const CellSurface& surface, const std::vector<int>& vertices,
                                      double enlargement = kDisplayScale);

}  // namespace microinjection
