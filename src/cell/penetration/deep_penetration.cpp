#include "cell/penetration/deep_penetration.h"

#include <boost/math/special_functions/fpclassify.hpp>

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace microinjection {
namespace {

constexpr double kSmallest = 1e-3;  ///< b / R that is searched
constexpr int kBits = 26;           ///< of ln(b / R)
constexpr int kPieces = 12;         ///< of the range of ln(b / R), of which the best is refined

}  // namespace

DeepPenetration::DeepPenetration(const MaterialConfig& material, double outer)
    : material_(makeMaterial(material)), hole_(*material_, outer) {}

SteadyPenetration DeepPenetration::steady(double toughness) const {
  SteadyPenetration result;
  if (toughness == 0) {
    result.hole_radius = 1;
    return result;
  }
  const auto cost = [&](double log_radius) {
    const double radius = std::exp(log_radius);
    return hole_.at(radius).energy + 2 * M_PI * radius * toughness;
  };
  const double lowest = std::log(kSmallest), width = -lowest / kPieces;
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = kPieces; i >= 1; --i) {
    const double radius = std::exp(lowest + i * width), energy = hole_.at(radius).energy;
    if (energy > least) break;  // it rises towards smaller radii, and a limit of stretch makes it infinite
    const double here = energy + 2 * M_PI * radius * toughness;
    if (here < least) {
      least = here;
      best = i;
    }
  }
  const auto found = boost::math::tools::brent_find_minima(cost, lowest + (best - 1) * width,
                                                           std::min(lowest + (best + 1) * width, 0.0), kBits);
  result.hole_radius = std::exp(found.first);
  result.force_in = found.second;
  const HoleExpansion::State state = hole_.at(result.hole_radius);
  result.force_out = state.energy;
  result.wall_pressure = state.pressure;
  return result;
}

double DeepPenetration::toughnessFor(double force) const {
  // The cost grows with the toughness, with a slope of at most 2 pi.
  const auto excess = [&](double log_toughness) { return steady(std::exp(log_toughness)).force_in / force - 1; };
  const double start = std::log(force / (2 * M_PI));
  std::uintmax_t iterations = 100;
  const auto bracket =
      boost::math::tools::bracket_and_solve_root([&](double x) { return excess(start + std::log(x)); }, 1.5, 2.0, true,
                                                 boost::math::tools::eps_tolerance<double>(30), iterations);
  return std::exp(start) * (bracket.first + bracket.second) / 2;
}

}  // namespace microinjection
