#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mechanics/surface_integral.h"

namespace microinjection {

/// Membrane tension of one layer's outer surface. The reference configuration is a sphere of radius
/// R, at rest under the tension: Laplace's pressure p0 = 2 gamma / R inside balances the tension
/// gamma. Energy, J,
///
///     gamma A(x) - p0 V(x) - G0 . u,  minus its undeformed value,
///
/// with A the deformed area of the surface and V the enclosed volume. Gamma and p0 do not depend on
/// the deformation. The tension resists changes of shape. Alone it does not resist changes of size:
/// a homogeneous ball needs a bulk modulus above 2 gamma / (3 R). The mesh's surface is not exactly
/// a sphere, so that its undeformed forces G0 = gamma dA/dx - p0 dV/dx are not exactly zero. They
/// are subtracted as a dead load, which makes the undeformed state an exact equilibrium, and vanish
/// with the size of the facets.
///
/// In a section (Dim = 2) area and volume are those of the whole surface of revolution.
///
/// A hole through the surface takes a part of its area away, whose energy is then missing, and p0 acts on the hole's
/// wall. At the rim nothing balances the tension, so that such a body is not at rest when it is undeformed.
template <int Dim>
class SurfaceTension : public EnergyTerm {
 public:
  /// @param radius of the layer's outer surface, m, > 0
  /// @param tension gamma, N/m, >= 0
  /// @throws std::invalid_argument when they are not, or when the body has no surface of this layer
  SurfaceTension(const LayeredBody<Dim>& body, int layer, double radius, double tension);

  double pressure() const { return pressure_; }               ///< p0, Pa
  double area(const Eigen::VectorXd& state) const;            ///< A, m^2
  double enclosedVolume(const Eigen::VectorXd& state) const;  ///< V, m^3

  int elementCount() const override { return static_cast<int>(facets_.size()); }
  const std::vector<int>& entries(int facet) const override { return facets_[facet].entries; }

  /// False when a facet has no area, or has crossed the axis (section).
  bool evaluate(int facet, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;

 private:
  using Positions = typename SurfaceIntegral<Dim>::Positions;
  struct Facet : SurfaceIntegral<Dim>::Facet {
    bool tense = true;          ///< of the surface; else of a hole's wall
    double energy;              ///< J, undeformed
    Eigen::VectorXd dead_load;  ///< N, this facet's part of G0
  };

  bool integrate(const Positions& x, double tension, double pressure, Order order, LocalEnergy& result) const;
  double total(const Eigen::VectorXd& state, double tension, double pressure) const;

  double tension_;
  double pressure_;
  SurfaceIntegral<Dim> surface_;
  std::vector<Facet> facets_;
};

}  // namespace microinjection
