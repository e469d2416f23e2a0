#include "operation/display/legend.h"

namespace microinjection {

Legend colourLegend(const Eigen::Vector3d& corner, double height, const ColourScale& scale) {
  constexpr int kSteps = 48, kTicks = 4;
  const double width = 0.06 * height;
  const auto at = [&](double across, double up) -> Eigen::Vector3d {
    return corner + Eigen::Vector3d(across * width, 0, up * height);
  };
  const auto value = [&](double fraction) { return scale.low() + fraction * (scale.high - scale.low()); };
  Legend legend;
  for (int step = 0; step < kSteps; ++step) {
    const double low = static_cast<double>(step) / kSteps, high = static_cast<double>(step + 1) / kSteps;
    const Colour below = scale.colour(value(low)), above = scale.colour(value(high));
    legend.bar.add(at(0, low), at(1, low), at(1, high));
    legend.bar.add(at(0, low), at(1, high), at(0, high));
    for (const Colour& colour : {below, below, above, below, above, above}) legend.bar.colours.push_back(colour);
  }
  for (int tick = 0; tick <= kTicks; ++tick) {
    const double fraction = static_cast<double>(tick) / kTicks;
    legend.labels.push_back({at(3.6, fraction), scale.figure(value(fraction))});
  }
  double up = 1.29;
  for (const std::string& line : scale.title()) {
    legend.labels.push_back({at(1.5, up), line});
    up -= 0.13;
  }
  return legend;
}

}  // namespace microinjection
