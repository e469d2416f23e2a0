#include "cell/model/biomembrane.h"

#include <cmath>

#include "base/config_errors.h"

namespace microinjection {

Biomembrane::Biomembrane(double young_modulus, double poisson_ratio, double tip_radius,
                         const BiomembraneConfig& config) {
  const double h = config.thickness, a = config.dimple_radius;
  ConfigErrors errors;
  errors.require(young_modulus > 0, "biomembrane: young_modulus", young_modulus, " Pa", "> 0 (Pa)");
  errors.require(Range::open(-1, 0.5), "biomembrane: poisson_ratio", poisson_ratio);
  errors.require(h > 0, "biomembrane: thickness", h, " m", "> 0 (m)");
  errors.require(tip_radius > 0 && tip_radius < a, "biomembrane: tip_radius", tip_radius, " m",
                 "in (0, dimple_radius) (m)");
  errors.throwAny();
  const double square = tip_radius * tip_radius / (a * a), L = 1 - square + std::log(square);
  const double numerator = 3 - 4 * square + square * square + 2 * std::log(square);
  strain_ = -numerator / (2 * L * L * a * a * (1 - square));
  coefficient_ = -4 * M_PI / L * young_modulus * h / (1 - poisson_ratio) * strain_;
}

}  // namespace microinjection
