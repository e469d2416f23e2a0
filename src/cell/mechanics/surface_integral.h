#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mechanics/reference_element.h"

namespace microinjection {

/// An energy per unit of the reference facet as a function of the position and the tangents there, in this order
/// (Dim^2 numbers), with its derivatives.
template <int Dim>
struct SurfaceDensity {
  double value = 0;
  Eigen::Matrix<double, Dim * Dim, 1> gradient = Eigen::Matrix<double, Dim * Dim, 1>::Zero();
  Eigen::Matrix<double, Dim * Dim, Dim* Dim> hessian = Eigen::Matrix<double, Dim * Dim, Dim * Dim>::Zero();
};

/// Integrals over the deformed surface of a body, facet by facet: tension, enclosed volume, suction. The surface has
/// the order of the body's displacement: quadratic (curved facets) or linear (flat ones between vertices).
template <int Dim>
class SurfaceIntegral {
 public:
  static constexpr int kMostNodes = QuadraticMesh<Dim>::kFacetNodes;
  using Positions = Eigen::Matrix<double, Dim, Eigen::Dynamic, Eigen::ColMajor, Dim, kMostNodes>;  ///< m, node by node
  struct Facet {
    std::vector<int> entries;  ///< of the state, node by node
    Positions undeformed;
  };

  explicit SurfaceIntegral(const LayeredBody<Dim>& body) {
    const bool quadratic = isQuadratic(body.kind());
    for (const ReferenceElement::Point& at : referenceFacet<Dim>().points) {
      Point point;
      point.weight = at.weight;
      point.shape.resize(quadratic ? kMostNodes : Dim, Dim);
      if (quadratic) {
        point.shape << at.shape, at.gradient;
      } else {
        point.shape << at.barycentric, Eigen::Matrix<double, Dim, Dim - 1>::Zero();
        point.shape.template block<1, Dim - 1>(0, 1).setConstant(-1);
        point.shape.template bottomRightCorner<Dim - 1, Dim - 1>().setIdentity();
      }
      points_.push_back(point);
    }
  }

  Facet facet(const LayeredBody<Dim>& body, const typename QuadraticMesh<Dim>::Facet& facet) const {
    const int nodes = static_cast<int>(points_[0].shape.rows());
    Facet result;
    result.undeformed.resize(Dim, nodes);
    for (int a = 0; a < nodes; ++a) {
      result.undeformed.col(a) = body.mesh().nodes[facet.nodes[a]];
      for (int k = 0; k < Dim; ++k) result.entries.push_back(Dim * facet.nodes[a] + k);
    }
    return result;
  }

  static Positions positions(const Facet& facet, const Eigen::VectorXd& state) {
    Positions x = facet.undeformed;
    for (int i = 0; i < x.size(); ++i) x.data()[i] += state[facet.entries[i]];
    return x;
  }

  /// Sums a density over one facet's quadrature points. `add`: (position and tangents, (Dim, Dim); SurfaceDensity&) ->
  /// false where it is not defined. False then, and where the sum is not finite.
  template <typename Add>
  bool integrate(const Positions& x, Order order, Add&& add, LocalEnergy& result) const {
    const int nodes = static_cast<int>(x.cols()), size = Dim * nodes;
    result.zero = false;
    result.energy = 0;
    if (order != Order::kEnergy) result.gradient.setZero(size);
    if (order == Order::kHessian) result.hessian.setZero(size, size);
    for (const Point& point : points_) {
      const Eigen::Matrix<double, Dim, Dim> at = x * point.shape;
      SurfaceDensity<Dim> density;
      if (!add(at, density)) return false;
      result.energy += point.weight * density.value;
      for (int a = 0; order != Order::kEnergy && a < nodes; ++a) {
        for (int i = 0; i < Dim; ++i) {
          const double share = point.weight * point.shape(a, i);
          result.gradient.template segment<Dim>(Dim * a) += share * density.gradient.template segment<Dim>(Dim * i);
        }
        if (order != Order::kHessian) continue;
        Eigen::Matrix<double, Dim, Dim* Dim> row = Eigen::Matrix<double, Dim, Dim * Dim>::Zero();
        for (int i = 0; i < Dim; ++i) {
          row += point.weight * point.shape(a, i) * density.hessian.template middleRows<Dim>(Dim * i);
        }
        for (int b = 0; b < nodes; ++b) {
          for (int j = 0; j < Dim; ++j) {
            result.hessian.template block<Dim, Dim>(Dim * a, Dim * b) +=
                point.shape(b, j) * row.template middleCols<Dim>(Dim * j);
          }
        }
      }
    }
    return std::isfinite(result.energy);
  }

 private:
  struct Point {
    double weight;
    /// Row of a node: its shape function and its derivatives by the reference coordinates.
    Eigen::Matrix<double, Eigen::Dynamic, Dim> shape;
  };
  std::vector<Point> points_;  ///< of every facet
};

}  // namespace microinjection
