#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/layered_body.h"

namespace microinjection {

struct CohesiveWallConfig {
  double radius = 0;     ///< m, of the undeformed hole, > 0
  double toughness = 0;  ///< J/m^2, > 0, spent by a wall that has opened wide
  double opening = 0;    ///< m, > 0, at which the traction is largest
  double closed = 0;     ///< Pa/m, >= 0, stiffness against a wall that goes nearer to the axis than it was
};

/// Tractions across the axis that hold the wall of a hole closed, in a body's section: a cohesive zone (Xu and
/// Needleman, "Numerical simulations of fast crack growth in brittle solids", J. Mech. Phys. Solids 42, 1994, normal
/// part). With o the wall's deformed distance from the axis less the hole's radius, per undeformed area of wall
///
///     energy    J (1 - (1 + o/d) exp(-o/d)),  o >= 0;   K o^2 / 2,  o < 0
///     traction  J o / d^2 exp(-o/d), at most J / (e d) at o = d.
///
/// A wall that has opened does not heal: below the largest opening so far the traction falls in proportion to o.
/// The wall slides freely along the axis.
class CohesiveWall : public EnergyTerm {
 public:
  /// Acts on the facets whose nodes are at the hole's radius. Throws std::invalid_argument when there are none, or for
  /// a configuration out of its range.
  CohesiveWall(const LayeredBody<2>& body, const CohesiveWallConfig& config);

  /// J/(e d), Pa.
  static double strength(const CohesiveWallConfig& config);

  int elementCount() const override { return static_cast<int>(facets_.size()); }
  const std::vector<int>& entries(int facet) const override { return facets_[facet].entries; }
  bool evaluate(int facet, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;
  void accept(const Eigen::VectorXd& state) override;
  void reset() override;

 private:
  struct Point {
    Eigen::VectorXd shape;  ///< of the facet's nodes
    double weight = 0;      ///< m^2, undeformed
    double largest = 0;     ///< m, opening so far
  };
  struct Facet {
    std::vector<int> entries;  ///< of the nodes' displacements across the axis
    std::vector<Point> points;
  };

  CohesiveWallConfig config_;
  std::vector<Facet> facets_;
};

}  // namespace microinjection
