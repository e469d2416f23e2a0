#pragma once

#include <memory>

#include "cell/material/material.h"
#include "cell/penetration/hole_expansion.h"

namespace microinjection {

/// Steady penetration of a blunt needle into a soft solid, by its balance of energy (Shergold and Fleck 2004, see
/// HoleExpansion). For each length that the needle advances, the crack costs its toughness J times the new wall of a
/// hole of undeformed radius b, and the solid around is stretched to the shaft's radius R. The hole has the radius for
/// which the sum is smallest:
///
///     force in   F = min over b of  E(b) + 2 pi b J
///     force out  E(b) of that hole: the closing hole pushes the needle's end, and the crack's energy is lost
///
/// Friction and adhesion of the shaft are not in it.
struct SteadyPenetration {
  double hole_radius = 0;    ///< b / R
  double force_in = 0;       ///< N / m^2: of R^2; infinite: the solid is not pierced
  double force_out = 0;      ///< N / m^2: of R^2, towards the outside
  double wall_pressure = 0;  ///< Pa, on the shaft
};

class DeepPenetration {
 public:
  /// `outer`: undeformed radius of the solid over that of the shaft, > 1
  explicit DeepPenetration(const MaterialConfig& material, double outer = 1000);

  /// @param toughness J over R, Pa, >= 0. Without toughness the hole needs no energy at all: both forces are 0.
  SteadyPenetration steady(double toughness) const;

  /// The toughness over R, Pa, at which the steady force in is `force`, N / m^2. @pre force > 0, finite
  double toughnessFor(double force) const;

 private:
  std::unique_ptr<Material> material_;
  HoleExpansion hole_;
};

}  // namespace microinjection
