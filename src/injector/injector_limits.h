#pragma once

#include <string>

#include "base/config_reader.h"
#include "injector/injector_device.h"

namespace microinjection {

/// What an injector may be asked for. Defaults are illustrative, of the class of an acq4-type pressure regulator.
struct InjectorLimits {
  Eigen::Vector2d pressure_range{-50e3, 50e3};  ///< Pa, gauge, lowest and highest
  Eigen::Vector2d duration_range{1e-3, 60};     ///< s, shortest and longest pulse

  static InjectorLimits read(ConfigReader& reader);

  /// Empty, or why the device cannot do it, with the value and what is allowed.
  std::string check(const InjectionPulse& pulse) const;
  std::string checkPressure(const std::string& what, double pressure) const;
};

}  // namespace microinjection
