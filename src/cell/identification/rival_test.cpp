#include "cell/identification/rival_test.h"

#include <algorithm>
#include <cmath>

#include "cell/identification/curve_fit.h"
#include "cell/identification/profile_interval.h"

namespace microinjection {
namespace {

constexpr int kNewtonSteps = 12;    ///< of Gauss and Newton
constexpr double kRatios = 2;       ///< that a rival has free
constexpr double kLawShape = 0.25;  ///< of a law's error, what fitted modulus and contact leave of it

}  // namespace

RivalComparison compareWithRivals(const EstimatedCell& estimated, const std::vector<RivalCell>& rivals,
                                  const AxisSamples& samples, const ShapeFitConfig& config, const ShapeFit& start) {
  RivalComparison result;
  result.own = fitShape(estimated.shape, samples, config, start, kNewtonSteps);
  result.modulus_low = result.modulus_high = result.own.modulus;
  std::vector<ShapeFit> fits;
  const double depth = samples.travel.maxCoeff() - result.own.contact;
  const double force = estimated.shape.at(depth).force;
  for (const RivalCell& rival : rivals) {
    ShapeFit from = result.own;
    from.modulus *= force / rival.shape.at(depth).force;
    fits.push_back(fitShape(rival.shape, samples, config, from, kNewtonSteps));
  }
  const auto best = std::min_element(fits.begin(), fits.end(),
                                     [](const ShapeFit& a, const ShapeFit& b) { return a.square < b.square; });
  if (best == fits.end() || !(depth > 0)) return result;
  const RivalCell& rival = rivals[static_cast<std::size_t>(best - fits.begin())];
  result.best = rival.description;
  result.best_modulus = best->modulus;
  const Eigen::VectorXd residuals =
      (samples.force - forcesOf(rival.shape, samples, *best)).cwiseQuotient(samples.deviation);
  const double correlation = correlationLength(residuals.cwiseMax(-5).cwiseMin(5));
  double own_force = 0;
  for (Eigen::Index i = 0; i < samples.force.size(); ++i) {
    own_force += std::pow(
        result.own.modulus * estimated.shape.at(samples.travel[i] - result.own.contact).force / samples.deviation[i],
        2);
  }
  const double gain = result.own.square - best->square;
  const double scale = correlation + std::pow(kLawShape * estimated.law_error, 2) * own_force;
  result.advantage = gain / scale - 2 * kRatios;
  const double as_good = std::min(result.own.square, best->square) + kChiSquared95 * scale;
  for (const ShapeFit& fit : fits) {
    if (fit.square > as_good) continue;
    result.modulus_low = std::min(result.modulus_low, fit.modulus);
    result.modulus_high = std::max(result.modulus_high, fit.modulus);
  }
  return result;
}

}  // namespace microinjection
