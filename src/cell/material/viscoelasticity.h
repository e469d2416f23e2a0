#pragma once

#include <string>
#include <vector>

namespace microinjection {

/// One Maxwell branch beside the elastic material.
struct PronyTerm {
  double modulus_ratio = 0;    ///< its modulus relative to the long-term distortional one, > 0
  double relaxation_time = 0;  ///< s, > 0
};

/// What a material adds to its elastic stress while it is being deformed: Maxwell branches (a Prony series of the
/// distortional part; the pressure does not relax) and a Kelvin-Voigt viscosity. ViscoelasticStep says how.
struct ViscoelasticityConfig {
  std::vector<PronyTerm> prony;
  double viscosity = 0;  ///< Pa s, of shear, >= 0

  bool empty() const { return prony.empty() && viscosity == 0; }

  /// One line an error: key, value and what is allowed.
  std::vector<std::string> errors() const;

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

}  // namespace microinjection
