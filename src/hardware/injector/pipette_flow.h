#pragma once

#include "base/config_reader.h"

namespace microinjection {

/// An injection pipette and its filling. Defaults are illustrative: an ICSI-like needle of 1 um
/// inner radius at the tip, filled from the back with an aqueous solution.
struct PipetteConfig {
  double tip_radius = 1e-6;          ///< m, inner
  double tip_length = 50e-6;         ///< m, of the straight end
  double shaft_radius = 0.25e-3;     ///< m, inner
  double taper_length = 8e-3;        ///< m, of the cone between tip and shaft
  double shaft_length = 40e-3;       ///< m, of the filled part of the shaft
  double viscosity = 1.0e-3;         ///< Pa s
  double surface_tension = 0.072;    ///< N/m, of the liquid against the air behind it
  double contact_angle = 0.35;       ///< rad, in the liquid; 20 degrees
  double meniscus_radius = 0.25e-3;  ///< m, inner radius where liquid and air meet
  double outside_pressure = 0;       ///< Pa, gauge, at the tip: in the dish or in the cell

  static PipetteConfig read(ConfigReader& reader);
};

/// Slow viscous flow through the pipette by Hagen-Poiseuille, in the taper with the local radius
/// (lubrication theory, valid for cones of a few degrees). Pressures are gauge (Pa). Flows out of
/// the tip are positive (m^3/s).
class PipetteFlow {
 public:
  explicit PipetteFlow(const PipetteConfig& config);

  /// Pa s/m^3: 8 viscosity / pi times the integral of r^-4 along the pipette.
  double resistance() const { return resistance_; }
  /// The pressure (Pa) behind the liquid at which nothing flows. Below it the pipette aspirates. It
  /// is the outside pressure and the capillary pressure of the meniscus, 2 gamma cos(theta) / r
  /// (Young-Laplace), which pulls the liquid back from the tip.
  double restPressure() const { return rest_; }

  /// Flow (m^3/s) at a pressure (Pa) behind the liquid. `clogging`: resistance relative to the
  /// clean pipette.
  double flow(double pressure, double clogging = 1) const {
    return (pressure - restPressure()) / (resistance_ * clogging);
  }

 private:
  double resistance_;
  double rest_;  // Pa
};

/// How far (m) from the mouth the interface between the medium and the pipette's filling is when so much (m^3) has been
/// drawn in: through the straight end, then the cone, then the shaft. @pre drawn >= 0
double interfaceDepth(const PipetteConfig& config, double drawn);

/// Integral of r^-4 (m^-3) along a cone of this length between two radii (m); equal radii make a
/// straight pipe.
double coneResistanceIntegral(double from_radius, double to_radius, double length);

}  // namespace microinjection
