#pragma once

#include <string>

#include "base/config_reader.h"
#include "hardware/injector/injector_device.h"

namespace microinjection {

/// Limits of the commands of an injector. Defaults are illustrative, of the class of an acq4-type
/// pressure regulator.
struct InjectorLimits {
  // Limits of the configured ranges.
  static constexpr double kVacuum = -101325;       ///< Pa, gauge
  static constexpr double kHighestPressure = 1e6;  ///< Pa, gauge; injectors for cells deliver about 0.6 MPa
  static constexpr double kLongestPulse = 3600;    ///< s

  Eigen::Vector2d pressure_range{-50e3, 50e3};  ///< Pa, gauge, lowest and highest
  Eigen::Vector2d duration_range{1e-3, 60};     ///< s, shortest and longest pulse

  static InjectorLimits read(ConfigReader& reader);

  /// Returns an empty text, or the value and the allowed range. Values that are not finite are
  /// never allowed.
  std::string check(const InjectionPulse& pulse) const;
  std::string checkPressure(const std::string& what, double pressure) const;
};

}  // namespace microinjection
