#pragma once

#include <array>
#include <vector>

namespace microinjection {

/// Stokes resistance of a sphere beside a plane, over that of the same sphere far from everything. A sphere of radius R
/// that moves at u and turns at w, n the plane's normal to its side, mu the viscosity, feels
///
///     F = -6 pi mu R   (parallel u_t + perpendicular u_n n - coupling R n x w)
///     T = -8 pi mu R^3 (rolling w_t + spin w_n n) - 6 pi mu R^2 coupling n x u
///
/// The two couplings are one number, by the reciprocal theorem. The coupling makes a sphere that is dragged along the
/// plane roll.
struct WallFactors {
  double perpendicular = 1;
  double parallel = 1;
  double coupling = 0;
  double rolling = 1;
  double spin = 1;
};

/// Series for a sphere whose surface is gap * R from the plane; relative errors below 1e-8 for gap >= 1e-4.
/// perpendicular: Brenner, Chem. Engng Sci. 16 (1961) 242, eq. 2.19. parallel: O'Neill, Mathematika 11 (1964) 67.
/// coupling and rolling: Dean and O'Neill, Mathematika 10 (1963) 13, and with it Goldman, Cox and Brenner, Chem. Engng
/// Sci. 22 (1967) 637. spin: Jeffery, Proc. London Math. Soc. 14 (1915) 327.
/// The translation parallel to the plane and the rotation about a parallel axis are solutions in bispherical
/// coordinates, whose coefficients satisfy a recurrence of three terms. @pre gap > 0
WallFactors wallSeries(double gap);

/// The same from a table that is made of the series once, by cubic interpolation in ln gap: a step cannot sum hundreds
/// of terms. Below the table, each factor goes on with the leading term of lubrication theory (Goldman, Cox and Brenner
/// 1967, eqs 2.65 and 3.13: 8/15, 2/15 and 2/5 of -ln gap; 1/gap of Brenner's), above it with Faxen's.
class WallResistance {
 public:
  WallResistance();

  WallFactors at(double gap) const;  ///< gap > 0, over the radius

 private:
  using Row = std::array<double, 5>;
  std::vector<Row> rows_;
};

}  // namespace microinjection
