#include "operation/display/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace microinjection {
namespace {

/// matplotlib's viridis from 0.25 to 1 in equal steps.
constexpr std::array<Colour, 13> kViridis = {{{0.230f, 0.322f, 0.546f},
                                              {0.199f, 0.388f, 0.555f},
                                              {0.173f, 0.449f, 0.558f},
                                              {0.149f, 0.508f, 0.557f},
                                              {0.128f, 0.567f, 0.551f},
                                              {0.121f, 0.626f, 0.533f},
                                              {0.158f, 0.684f, 0.502f},
                                              {0.246f, 0.739f, 0.452f},
                                              {0.369f, 0.789f, 0.383f},
                                              {0.516f, 0.831f, 0.294f},
                                              {0.678f, 0.864f, 0.190f},
                                              {0.846f, 0.887f, 0.100f},
                                              {0.993f, 0.906f, 0.144f}}};

/// Moreland's map in steps of a quarter.
constexpr std::array<Colour, 9> kDiverging = {{{0.230f, 0.299f, 0.754f},
                                               {0.384f, 0.510f, 0.918f},
                                               {0.552f, 0.691f, 0.996f},
                                               {0.722f, 0.813f, 0.975f},
                                               {0.865f, 0.865f, 0.865f},
                                               {0.955f, 0.772f, 0.680f},
                                               {0.958f, 0.604f, 0.482f},
                                               {0.870f, 0.396f, 0.314f},
                                               {0.706f, 0.016f, 0.150f}}};

template <std::size_t Size>
Colour interpolated(const std::array<Colour, Size>& table, double fraction) {
  const double position = std::isfinite(fraction) ? std::clamp(fraction, 0.0, 1.0) * (Size - 1) : 0;
  const std::size_t lower = std::min(static_cast<std::size_t>(position), Size - 2);
  const float weight = static_cast<float>(position - static_cast<double>(lower));
  const Colour& a = table[lower];
  const Colour& b = table[lower + 1];
  return {a.r + weight * (b.r - a.r), a.g + weight * (b.g - a.g), a.b + weight * (b.b - a.b), 1};
}

}  // namespace

Colour colourOfFraction(double fraction) { return interpolated(kViridis, fraction); }

Colour colourOfSignedFraction(double fraction) { return interpolated(kDiverging, (1 + fraction) / 2); }

double niceCeiling(double value) {
  if (!(value > 0)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.2, 1.6, 2.0, 2.4, 3.2, 4.0, 6.0, 8.0}) {
    if (value <= step * decade * (1 + 1e-3)) return step * decade;
  }
  return 10 * decade;
}

double lampLight(const Eigen::Vector3d& normal) {
  static const Eigen::Vector3d to_lamp = Eigen::Vector3d(-0.4, -0.7, 0.6).normalized();
  constexpr double kAmbient = 0.65, kDiffuse = 0.45, kSky = 0.08;
  return kAmbient + kDiffuse * std::max(0.0, normal.dot(to_lamp)) + kSky * normal.z();
}

Colour shaded(const Colour& colour, double light) {
  const auto scaled = [light](float channel) {
    return static_cast<float>(std::clamp(light * static_cast<double>(channel), 0.0, 1.0));
  };
  return {scaled(colour.r), scaled(colour.g), scaled(colour.b), colour.a};
}

}  // namespace microinjection
