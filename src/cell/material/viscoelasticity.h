#pragma once

#include <string>
#include <vector>

#include "base/config_errors.h"

namespace microinjection {

/// One Maxwell branch parallel to the elastic material.
struct PronyTerm {
  double modulus_ratio = 0;    ///< its modulus relative to the long-term distortional one, > 0
  double relaxation_time = 0;  ///< s, > 0
};

/// Time-dependent part of a material's stress: Maxwell branches (a Prony series of the distortional
/// part; the pressure does not relax) and a Kelvin-Voigt viscosity. See ViscoelasticStep for the
/// equations.
struct ViscoelasticityConfig {
  std::vector<PronyTerm> prony;
  double viscosity = 0;  ///< Pa s, of shear, >= 0

  bool empty() const { return prony.empty() && viscosity == 0; }

  /// Adds the errors of this configuration, with `path` before each key.
  void check(const std::string& path, ConfigErrors& errors) const;
};

}  // namespace microinjection
