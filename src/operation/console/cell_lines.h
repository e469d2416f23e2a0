#pragma once

#include <optional>
#include <string>

#include "operation/console/light.h"

namespace microinjection {

/// What the estimator says of the cell; moduli in Pa, depths in m, forces in N.
struct CellEstimateView {
  std::string verdict;  ///< prior, learning, converged or inconsistent
  std::string reason;   ///< why it is not converged
  double modulus = 0, low = 0, high = 0;
  double served_modulus = 0;
  double puncture_depth = 0, puncture_low = 0, puncture_high = 0, puncture_force = 0;  ///< 0: no prediction
};

/// The modulus with its interval, and the verdict; grey without an estimate, green when converged,
/// yellow else, red when inconsistent.
Lamp estimateLamp(const std::optional<CellEstimateView>& estimate);

/// "puncture at 31.2 um (27.0 to 35.5), 1.30 uN"; empty: no prediction.
std::string punctureText(const std::optional<CellEstimateView>& estimate);

/// The state of the injector.
struct InjectorView {
  double pressure = 0;  ///< Pa, gauge
  double volume = 0;    ///< m^3, out of the tip since the last reset
  bool busy = false;
  unsigned pulses = 0;
  std::string fault, refusal;
};
/// Red with a fault or when one that was heard is silent, yellow after a refusal, grey without one.
Lamp injectorLamp(const std::optional<InjectorView>& injector, bool heard);
/// "2.46 kPa, 1.2 pL, 1 pulse"
std::string injectorText(const InjectorView& injector);

}  // namespace microinjection
