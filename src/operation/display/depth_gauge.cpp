#include "operation/display/depth_gauge.h"

#include <algorithm>

#include "operation/display/colour_map.h"
#include "operation/display/readout.h"

namespace microinjection {

DepthGauge depthGauge(const Eigen::Vector3d& top, double height, const PunctureDepth& puncture,
                      const std::optional<double>& indentation) {
  constexpr int kTicks = 4;
  constexpr double kTick = 0.02, kLabel = -0.09;  // display units beside the scale
  const double depth = std::max(0.0, indentation.value_or(0));
  const double range = niceCeiling(std::max(puncture.high, depth));
  const auto at = [&](double deep, double across) -> Eigen::Vector3d {
    return top + Eigen::Vector3d(across, 0, -height * deep / range);
  };
  DepthGauge gauge;
  gauge.scale = {at(0, 0), at(range, 0)};
  for (int tick = 0; tick <= kTicks; ++tick) {
    const double deep = range * tick / kTicks;
    gauge.scale.insert(gauge.scale.end(), {at(deep, -kTick), at(deep, 0)});
    gauge.labels.push_back({at(deep, kLabel), micro(deep, 3)});
  }
  gauge.labels.push_back({top + Eigen::Vector3d(0, 0, 0.17 * height), "puncture, um deep"});
  gauge.interval = {at(puncture.low, 0), at(puncture.high, 0)};
  if (!puncture.beyond) gauge.expected = {at(puncture.depth, 0)};
  if (indentation) gauge.present = {at(depth, kTick)};
  return gauge;
}

}  // namespace microinjection
