#pragma once

#include "cell/contact/pipette_mouth.h"
#include "cell/pose/cell_motion_config.h"

namespace microinjection {

/// Pressure and flow of a holding pipette whose mouth a sphere closes, or nearly so.
///
/// The flow Q passes three resistances in series, mu the viscosity:
///
///     the gap about the lip, of even height g, between sphere and edge:  (9/4) mu sqrt(2 c) / (s g^(5/2)),
///       1 / c = 1 / R + 1 / e                                            s: radius of the circle of first touch
///     the entry of the bore, of radius a:                                3 mu / (2 a^3)      (half of Sampson's)
///     the bore, of length L:                                             8 mu L / (pi a^4)   (Poiseuille)
///
/// The first is Reynolds' equation in the film h = g + x^2 / (2 c) across the lip: the pressure falls by 12 mu q
/// integral of dx / h^3 = 12 mu q (3 pi / 8) sqrt(2 c) g^(-5/2), where q = Q / (2 pi s). The other two add up in series
/// within a few percent (Dagan, Weinbaum and Pfeffer, J. Fluid Mech. 115 (1982) 505). A notch of the lip, a hole of a
/// given area through the wall 2 e, is parallel to the gap: a round one's 3 mu / r^3 + 16 mu e / (pi r^4).
///
/// So the sphere feels the share of the pressure, sigma, that falls over the gap, on the circle that the lip closes:
/// the force p pi s^2 sigma(g). It acts from the sphere's centre towards the middle of that circle, because a pressure
/// on a cap of a sphere has no moment about the centre. With g = distance of the two less that at touch, it has a
/// potential, p pi s^2 S(g), S the integral of sigma.
///
///     sigma = closed / (1 + (g / g0)^(5/2))     closed < 1 with a notch
///
/// A gap as high as s holds no film, and the pressure in front of a wide gap is that of the bath. So sigma is shifted
/// by its value there, to end there.
///
/// What flows is drawn from all sides. In the sink flow Q / (4 pi r^2) Faxen's correction vanishes, since it is
/// irrotational, so that the drag on the sphere is Stokes' and has a potential, too.
class LipSuction {
 public:
  LipSuction(const PipetteMouth& mouth, const CellMotionConfig& config);

  bool swallows() const { return swallows_; }  ///< whether the bore is wider than the sphere
  double sealRadius() const { return seal_; }  ///< m, s; of a bore that swallows, the sphere's
  double area() const;                         ///< m^2, pi s^2
  /// m, of the circle at which a soft cell leaves the lip when it is pulled off: that of first touch for a weak
  /// suction, nearer to the bore for a strong one, because the surface bulges. It is steeper there by the slope that
  /// suction p gives a half-space beside its disc (Johnson, "Contact mechanics", 1985, ch. 3.4),
  ///
  ///     (4 / pi) (p / E*) (K(k) - E(k)),   k = s / (s + 0.17 e)
  ///
  /// K and E the complete elliptic integrals, and touches the lip where the lip is as steep. The distance 0.17 e is
  /// fitted to solved cells: their pull is met within 2.4 % for p of 0.02 to 0.15 E (`./dev bench slip`).
  /// @param suction Pa, >= 0
  double releasedRadius(double suction) const;
  /// N/m, of a soft cell that suction presses on the lip, against a small shift across the tube: the push on the circle
  /// changes by q cos(phi). What is added to a Hertzian strip's load lies on it as 1 / sqrt(a^2 - x^2), and a
  /// half-space yields to such a ring by
  ///
  ///     (2 q / (pi E*)) (ln(8 s / a) + ln(2) - 2)     q: N/m, a^2 = 4 q0 c / (pi E*), q0 that of the suction, a <= s
  ///
  /// (point forces, Johnson, "Contact mechanics", 1985, eq. 3.22, summed about the ring). 0 for a bore that swallows.
  /// @param suction Pa, > 0
  double lateralStiffness(double suction) const;
  double middle() const { return middle_; }  ///< m, of the circle behind the lip's crest, along the tube
  double touch() const { return touch_; }    ///< m, of the sphere's centre from the middle at touch

  /// A notch's conductance, m^3/(Pa s). @param area m^2, >= 0
  double notchConductance(double area) const;
  /// Share of the pressure that acts on the sphere, at a gap (m, >= 0) and a notch's conductance.
  double share(double gap, double notch) const;
  /// m, integral of share() from 0 to the gap; for a negative gap its linear continuation.
  double shareIntegral(double gap, double notch) const;
  /// m^3/s at a pressure of 1 Pa, into the bath; the share is that of share().
  double flow(double share) const { return (1 - share) / series_; }

 private:
  double scale(double notch) const;  ///< m, g0

  bool swallows_;
  double seal_, middle_, touch_, viscosity_, edge_;
  double crest_, radius_, modulus_;  ///< m, of the lip's inner crest; m, of the sphere; Pa, E*
  double gap_coefficient_;           ///< Pa s m^(-1/2): the gap's resistance times g^(5/2)
  double series_;                    ///< Pa s/m^3, of entry and bore
};

}  // namespace microinjection
