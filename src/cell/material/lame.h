#pragma once

namespace microinjection {

/// Lame's constants of an isotropic material, Pa.
struct Lame {
  double lambda = 0;
  double mu = 0;

  /// @pre young_modulus > 0, -1 < poisson_ratio < 0.5
  static Lame from(double young_modulus, double poisson_ratio) {
    return {young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
            young_modulus / (2 * (1 + poisson_ratio))};
  }
};

}  // namespace microinjection
