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

}  // namespace

Colour colourOfFraction(double fraction) {
  const double position = std::clamp(fraction, 0.0, 1.0) * (kViridis.size() - 1);
  const std::size_t lower = std::min(static_cast<std::size_t>(position), kViridis.size() - 2);
  const float weight = static_cast<float>(position - static_cast<double>(lower));
  const Colour& a = kViridis[lower];
  const Colour& b = kViridis[lower + 1];
  return {a.r + weight * (b.r - a.r), a.g + weight * (b.g - a.g), a.b + weight * (b.b - a.b), 1};
}

double niceCeiling(double value) {
  if (!(value > 0)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.2, 1.6, 2.0, 2.4, 3.2, 4.0, 6.0, 8.0}) {
    if (value <= step * decade * (1 + 1e-3)) return step * decade;
  }
  return 10 * decade;
}

}  // namespace microinjection
