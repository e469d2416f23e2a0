#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "cell/mesh/tet_mesh.h"
#include "cell/mesh/triangle_mesh.h"

namespace microinjection {

/// Second-order mesh of a ball of concentric layers: tetrahedra in space (Dim = 3), or triangles of
/// its section r >= 0 in the (r, z) plane (Dim = 2). Nodes are the vertices of the linear mesh,
/// then the midpoints of its edges. Midpoints on a layer's surface lie on its sphere, so that those
/// elements are curved.
template <int Dim>
struct QuadraticMesh {
  static constexpr int kCorners = Dim + 1;
  static constexpr int kNodes = Dim == 2 ? 6 : 10;
  static constexpr int kFacetNodes = Dim == 2 ? 3 : 6;
  using Point = Eigen::Matrix<double, Dim, 1>;

  /// Piece of a layer's outer surface: corners, then midpoints. Seen from outside, its corners are
  /// counter-clockwise (in space); along a section's arc they go from -z to +z.
  struct Facet {
    std::array<int, kFacetNodes> nodes;
    int layer;           ///< of the element; between two layers the inner one's
    bool outer = false;  ///< nothing is behind it
  };

  std::vector<Point> nodes;                       ///< m
  int vertex_count = 0;                           ///< nodes below are vertices
  std::vector<std::array<int, kNodes>> elements;  ///< corners, then midpoints of elementEdges(), positively oriented
  std::vector<int> layers;                        ///< of each element, 0 outermost
  std::vector<Facet> facets;
};

/// Corners of the edge on whose middle each midpoint of an element lies.
template <int Dim>
const std::vector<std::array<int, 2>>& elementEdges();
template <>
const std::vector<std::array<int, 2>>& elementEdges<2>();
template <>
const std::vector<std::array<int, 2>>& elementEdges<3>();

/// `radii`: outer radius of each layer, m, outermost first. A facet is a face between elements of
/// two layers, or a face of one element only that is not on the axis.
QuadraticMesh<3> makeQuadratic(const TetMesh& mesh, const std::vector<double>& radii);
QuadraticMesh<2> makeQuadratic(const TriangleMesh& mesh, const std::vector<double>& radii);

/// With given midpoints: `middle` returns the midpoint (m) of the edge between two vertices.
QuadraticMesh<3> makeQuadratic(const TetMesh& mesh, const std::function<Eigen::Vector3d(int, int)>& middle);

}  // namespace microinjection
