#include "cell/identification/combined_modulus.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace microinjection {
namespace {

constexpr double kInterval = 1.96;  ///< deviations, half an interval of 95 %

constexpr double kLeast = 1e-9;  ///< of the logarithm: an interval without a width has a weight, too

double deviationOf(const Estimate& modulus) {
  return std::max(kLeast, std::log(modulus.high / modulus.low) / (2 * kInterval));
}

}  // namespace

Identification combineModuli(const Identification& force, const Identification& tongue) {
  const Estimate &by_force = *force.find("young_modulus"), &by_tongue = *tongue.find("young_modulus");
  Identification result;
  if (!by_force.bounded() && !by_tongue.bounded()) {
    result = tongue;
    result.warnings.emplace_back("neither the force nor the tongues bound the modulus");
    return result;
  }
  if (!by_force.bounded() || !by_tongue.bounded()) {
    result = by_force.bounded() ? force : tongue;
    result.warnings.emplace_back(by_force.bounded()
                                     ? "the tongues do not bound the modulus: it is that of the force"
                                     : "the force does not bound the modulus: it is that of the tongues");
    return result;
  }
  const double first = deviationOf(by_force), second = deviationOf(by_tongue), joint = std::hypot(first, second);
  const double share = second * second / (joint * joint), deviation = first * second / joint;
  const double apart = std::log(by_tongue.value / by_force.value);
  const double logarithm = std::log(by_force.value) + (1 - share) * apart, wide = std::exp(kInterval * deviation);
  const double modulus = std::exp(logarithm);
  char text[160];
  std::snprintf(text, sizeof(text),
                "force and tongues, of which the force has %.0f %% of the weight; they differ by %.2g %%", 100 * share,
                100 * std::abs(std::expm1(apart)));
  result.model = text;
  result.estimates = {{"young_modulus", "Pa", modulus, modulus / wide, modulus * wide, true}};
  result.size = 1;
  result.misfit = std::abs(apart);
  result.scatter = joint;
  return result;
}

}  // namespace microinjection
