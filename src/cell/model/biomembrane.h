#pragma once

namespace microinjection {

struct BiomembraneConfig {
  double thickness = 0;      ///< m, h, of the membrane (zona pellucida)
  double dimple_radius = 0;  ///< m, a, outer radius of the dent around the needle; observed, or assumed
};

/// Force on a needle that dents a membrane with only a pressure behind it: the point-load model of
/// Sun, Wan, Roberts and Nelson, "Mechanical property characterization of mouse zona pellucida",
/// IEEE Transactions on NanoBioscience 2(4), 2003, with zeta = c/a,
///
///     F = 2 pi E h w^3/(a^2 (1 - nu)) (3 - 4 zeta^2 + zeta^4 + 2 ln zeta^2)/((1 - zeta^2) L^3),
///     L = 1 - zeta^2 + ln zeta^2.
///
/// Derivation. The membrane between the tip's edge r = c and the dimple's edge r = a has the same
/// tension T everywhere. A uniform pressure p from inside holds the dimple as a whole, F = pi a^2
/// p, so that the membrane is horizontal at its edge. Vertical balance of the part within r, 2 pi r
/// T w' = -F (1 - r^2/a^2) (w: depth), gives w and, at r = c, F = -4 pi T w_c / L. The membrane's
/// area grows by int w'^2/2 dA. If that is uniform, the biaxial strain is half of it over pi (a^2 -
/// c^2), and T = E h / (1 - nu) times that strain. Both together are the formula. (Some copies have
/// zeta^2 ln zeta^2 in the numerator: for a fine tip the force would then be negative.) The work of
/// needle and pressure, F dw - p dV, is the change of the membrane's energy.
///
/// Valid for a thin membrane (h well below a) that is slack at first, stretches little ((w/a)^2
/// well below 1) and uniformly, over a soft inside. It includes neither bending, nor the inside's
/// own resistance, which dominates at small depths, nor a growing dimple. The force grows with the
/// cube of the depth without limit; there is no puncture.
class Biomembrane {
 public:
  /// young_modulus E, Pa; tip_radius c, m. Throws ConfigError unless E > 0, -1 < nu < 0.5, h > 0
  /// and 0 < c < a.
  Biomembrane(double young_modulus, double poisson_ratio, double tip_radius, const BiomembraneConfig& config);

  double force(double depth) const { return coefficient_ * depth * depth * depth; }  ///< N; depth w >= 0, m
  double stiffness(double depth) const { return 3 * coefficient_ * depth * depth; }  ///< N/m, dF/dw
  double strain(double depth) const { return strain_ * depth * depth; }              ///< biaxial

 private:
  double coefficient_;  ///< N/m^3
  double strain_;       ///< 1/m^2
};

}  // namespace microinjection
