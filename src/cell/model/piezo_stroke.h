#pragma once

#include <cmath>

namespace microinjection {

/// A pulse of a piezo-driven needle: its tip goes ahead along the pipette as amplitude (1 - cos(pi t / rise_time)) / 2
/// and comes back to where it was, within less than a step of a 1 kHz loop.
struct PiezoPulse {
  double amplitude = 0;  ///< m
  double rise_time = 0;  ///< s
};

/// What a membrane and the liquid behind it oppose to a tip that is much faster than any indentation.
struct StrokeResistance {
  static constexpr double kDensity = 1e3;  ///< kg/m^3, of the liquid

  double tip_radius = 0;  ///< m
  double viscosity = 0;   ///< Pa s, of the cytoplasm
  double stiffness = 0;   ///< N/m, of the dent over the amplitude when nothing is fast

  /// Largest force of the pulse along the pipette, N, beside that of the dent before it:
  ///
  ///     max over t of  k x + c x' + m x'',   c = 8 eta R,   m = 4/3 rho R^3
  ///
  /// c and m are half the drag and the added mass of a disc that moves broadside (Lamb, Hydrodynamics; Happel and
  /// Brenner), the half behind the membrane; the medium in front of it moves with the needle. Stokes' drag holds as
  /// long as sqrt(eta rise_time / rho) is above R: for 0.2 Pa s and 50 us it is 100 um. It is the force of a membrane
  /// that goes with the tip; a bound for one that gives way sooner.
  double largestForce(const PiezoPulse& pulse) const {
    // With p = pi t / rise_time it is elastic + (inertia - elastic) cos p + drag sin p.
    const double half = pulse.amplitude / 2, pace = M_PI / pulse.rise_time;
    const double elastic = stiffness * half, drag = 8 * viscosity * tip_radius * half * pace;
    const double inertia = 4.0 / 3 * kDensity * std::pow(tip_radius, 3) * half * pace * pace;
    return elastic + std::hypot(inertia - elastic, drag);
  }
};

}  // namespace microinjection
