#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace microinjection {

/// A curved facet of second order: its corners counter-clockwise as seen from outside, then the nodes in the middle of
/// the edges 01, 12 and 20.
using QuadraticFacet = std::array<int, 6>;

/// The facets of a surface whose triangles come in fours, as outerTriangles() makes them of second-order elements:
/// three at the corners and one between the nodes in the middle. Empty: it is made of something else.
std::vector<QuadraticFacet> quadraticFacets(const std::vector<std::array<int, 3>>& triangles);

/// Sums of the facets' outward normals at each vertex, as long as the area around it (in the vertices' unit squared);
/// zero at a vertex without a facet. Each normal is that of the curved facet itself, across its tangents: on a sphere
/// its error falls with the cube of the facets' size (test/operation/display/quadratic_facets_test.cpp).
std::vector<Eigen::Vector3d> quadraticNormals(const std::vector<Eigen::Vector3d>& vertices,
                                              const std::vector<QuadraticFacet>& facets);

}  // namespace microinjection
