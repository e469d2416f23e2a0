#pragma once

#include <string>

#include "base/config_reader.h"
#include "rig/injector/injector_device.h"

namespace microinjection {

/// What an injector may be asked for. Defaults are illustrative, of the class of an acq4-type pressure regulator.
struct InjectorLimits {
  // What the ranges themselves may be.
  static constexpr double kVacuum = -101325;       ///< Pa, gauge
  static constexpr double kHighestPressure = 1e6;  ///< Pa, gauge; above what injectors of cells deliver (some 0.6 MPa)
  static constexpr double kLongestPulse = 3600;    ///< s

  Eigen::Vector2d pressure_range{-50e3, 50e3};  ///< Pa, gauge, lowest and highest
  Eigen::Vector2d duration_range{1e-3, 60};     ///< s, shortest and longest pulse

  static InjectorLimits read(ConfigReader& reader);

  /// Empty, or why the device cannot do it, with the value and what is allowed; what is not finite is never allowed.
  std::string check(const InjectionPulse& pulse) const;
  std::string checkPressure(const std::string& what, double pressure) const;
};

}  // namespace microinjection
