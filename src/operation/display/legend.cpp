#include "operation/display/legend.h"

#include "operation/display/readout.h"

namespace microinjection {

Legend displacementLegend(const Eigen::Vector3d& corner, double height, double range) {
  constexpr int kSteps = 48, kTicks = 4;
  const double width = 0.06 * height;
  const auto at = [&](double across, double up) -> Eigen::Vector3d {
    return corner + Eigen::Vector3d(across * width, 0, up * height);
  };
  Legend legend;
  for (int step = 0; step < kSteps; ++step) {
    const double low = static_cast<double>(step) / kSteps, high = static_cast<double>(step + 1) / kSteps;
    const Colour below = colourOfFraction(low), above = colourOfFraction(high);
    legend.bar.add(at(0, low), at(1, low), at(1, high));
    legend.bar.add(at(0, low), at(1, high), at(0, high));
    for (const Colour& colour : {below, below, above, below, above, above}) legend.bar.colours.push_back(colour);
  }
  for (int tick = 0; tick <= kTicks; ++tick) {
    const double fraction = static_cast<double>(tick) / kTicks;
    legend.labels.push_back({at(3.6, fraction), micro(fraction * range, 3)});
  }
  legend.labels.push_back({at(1.5, 1.17), "displacement, um"});
  return legend;
}

}  // namespace microinjection
