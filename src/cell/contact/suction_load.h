#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/contact/pipette_mouth.h"
#include "cell/contact/rigid_contact.h"
#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/surface_integral.h"

namespace microinjection {

/// Pressure of the liquid in a pipette's bore on the part of a cell's surface that closes its mouth: a follower load,
/// normal to the deformed surface.
///
/// It has an energy. Let p(x) be a pressure given in space: p within the cylinder of radius s about the pipette's axis,
/// 0 outside. By Reynolds' theorem the integral of p(x) over the deformed body has the load's virtual work as its
/// derivative, for any p(x), and at the surface only; with the divergence theorem it becomes
///
///     p V,  V = integral over the surface of  chi(r) (z - z0) n_z dA,    z0: plane of the lip
///
/// in which chi falls from 1 to 0 about r = s. V is the volume of the tongue in the bore, and is negative as long as
/// the surface is outside. Suction, p < 0, lowers the energy where the tongue grows.
///
///              bore |  tongue  | bore                 contact with the lip: whatever chi is there,
///                   |  .-''-.  |                      the contact's pressure makes up for it
///         lip      (_)'      '(_)
///         . . . . . . .|. . . .|. . . . z0
///                      |<- s ->|
///
/// So the solution does not depend on s, the seal, as long as the circle lies where the surface touches the lip. The
/// cell's contact with the lip is an unknown; hence s follows it: at the end of a step, when the circle has left the
/// middle of the contact, it is put back there, and the step is solved again.
///
/// The pressure is an entry of the state, in units that make it a length, so that LoadPath follows it as it follows the
/// tip's translation; the force of that entry is unit() times V.
template <int Dim>
class SuctionLoad : public EnergyTerm {
 public:
  /// @param lip the contact of this mouth, which knows where the surface touches; settled before this term
  /// @param plane z of the lip's crest, m, in the body's frame
  /// @param entry of the state: the pressure
  /// @param unit Pa/m, > 0, of that entry
  SuctionLoad(const LayeredBody<Dim>& body, const PipetteMouth& mouth, double cell_radius, double plane,
              std::shared_ptr<const RigidContact<Dim>> lip, int entry, double unit);

  double unit() const { return unit_; }
  double sealRadius() const { return seal_; }         ///< m, s
  double volume(const Eigen::VectorXd& state) const;  ///< V, m^3
  double apex(const Eigen::VectorXd& state) const;    ///< m, how far the surface reaches behind the lip's plane

  int elementCount() const override { return static_cast<int>(facets_.size()); }
  const std::vector<int>& entries(int facet) const override { return facets_[facet].entries; }
  bool evaluate(int facet, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;
  bool beginStep(double duration) override;
  bool settle(const Eigen::VectorXd& state) override;
  void accept(const Eigen::VectorXd& state) override;
  void reset() override;

 private:
  using Facet = typename SurfaceIntegral<Dim>::Facet;  ///< entries end with that of the pressure

  bool integrate(const Facet& facet, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const;

  SurfaceIntegral<Dim> surface_;
  std::vector<Facet> facets_;
  std::shared_ptr<const RigidContact<Dim>> lip_;
  double plane_, side_, width_, first_seal_, seal_, accepted_seal_;  ///< m but for side_
  int entry_;
  double unit_;
};

}  // namespace microinjection
