#include "cell/biomembrane.h"

#include <cmath>
#include <string>
#include <vector>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

Biomembrane::Biomembrane(double young_modulus, double poisson_ratio, double tip_radius,
                         const BiomembraneConfig& config) {
  const double h = config.thickness, a = config.dimple_radius;
  std::vector<std::string> errors;
  const auto require = [&](bool good, const std::string& key, double value, const std::string& allowed) {
    if (!good) errors.push_back("biomembrane: " + key + " = " + std::to_string(value) + ": must be " + allowed);
  };
  require(young_modulus > 0, "young_modulus", young_modulus, "> 0 (Pa)");
  require(poisson_ratio > -1 && poisson_ratio < 0.5, "poisson_ratio", poisson_ratio, "in (-1, 0.5)");
  require(h > 0, "thickness", h, "> 0 (m)");
  require(tip_radius > 0 && tip_radius < a, "tip_radius", tip_radius, "in (0, dimple_radius) (m)");
  if (!errors.empty()) throw ConfigError(errors);
  const double square = tip_radius * tip_radius / (a * a), L = 1 - square + std::log(square);
  const double numerator = 3 - 4 * square + square * square + 2 * std::log(square);
  strain_ = -numerator / (2 * L * L * a * a * (1 - square));
  coefficient_ = -4 * kPi / L * young_modulus * h / (1 - poisson_ratio) * strain_;
}

}  // namespace microinjection
