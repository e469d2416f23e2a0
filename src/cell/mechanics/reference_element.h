#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace microinjection {

/// Interpolation of displacement and pressure on a simplex.
enum class ElementKind {
  kP1,    ///< linear displacement, no pressure: the paper's; locks when nearly incompressible
  kMini,  ///< linear displacement with a bubble, continuous linear pressure (Arnold, Brezzi, Fortin 1984)
  kP1P1,  ///< linear displacement, continuous linear pressure, stabilised by its projection (Dohrmann, Bochev 2004)
  kP2,    ///< quadratic displacement, no pressure
  kP2P0,  ///< quadratic displacement, one pressure per element, eliminated there (Constraints::kInternal)
  kP2P1   ///< Taylor-Hood: quadratic displacement, continuous linear pressure
};

const std::vector<std::string>& elementNames();    ///< p1, mini, p1_p1, p2, p2_p0, p2_p1
ElementKind elementKind(const std::string& name);  ///< @pre one of elementNames()
const std::string& elementName(ElementKind kind);
bool hasContinuousPressure(ElementKind kind);  ///< one unknown per vertex; the equations are indefinite
bool isQuadratic(ElementKind kind);

/// Shape functions at the points of a quadrature rule on the reference simplex.
struct ReferenceElement {
  struct Point {
    double weight;                 ///< on the reference simplex; the sum is 1/2 (Dim 2) or 1/6 (Dim 3)
    Eigen::VectorXd barycentric;   ///< linear shape functions, of pressure and of linear geometry
    Eigen::VectorXd shape;         ///< shape functions of displacement
    Eigen::MatrixXd gradient;      ///< their gradients by reference coordinates (nodes x Dim)
    Eigen::VectorXd map;           ///< shape functions of the geometry: linear or quadratic
    Eigen::MatrixXd map_gradient;  ///< (geometry nodes x Dim)
  };
  int nodes;  ///< of displacement: corners and midpoints, or corners and the bubble
  std::vector<Point> points;
};

/// Dim 2: triangle, six points, degree 4. Dim 3: tetrahedron, four points, degree 2 (14 points,
/// degree 5, with a bubble).
template <int Dim>
const ReferenceElement& referenceElement(ElementKind kind);

/// Quadratic shape functions and gradients of a facet (Dim 2: edge, three nodes; Dim 3: triangle,
/// six nodes).
template <int Dim>
const ReferenceElement& referenceFacet();
template <>
const ReferenceElement& referenceFacet<2>();
template <>
const ReferenceElement& referenceFacet<3>();

}  // namespace microinjection
