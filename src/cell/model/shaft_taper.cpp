#include "cell/model/shaft_taper.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "base/errors.h"
#include "cell/penetration/hole_expansion.h"

namespace microinjection {
namespace {

constexpr int kIntervals = 48;  ///< of the cell's diameter

/// N: J per metre of a hole's wall that a shaft has opened; infinite where there is no such state.
double openedTo(double radius, double hole, double cell_radius, const Material& material) {
  try {
    return radius * radius * HoleExpansion(material, std::max(cell_radius / radius, 1.5)).at(hole / radius).energy;
  } catch (const std::runtime_error&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace

ShaftTaper::ShaftTaper(const Scene& scene, double hole, double dent)
    : dent_(dent), step_(2 * scene.radius() / kIntervals) {
  const double tip = scene.needle.tip.radius, slope = std::tan(scene.needle.tip.taper);
  const auto material = makeMaterial(scene.cell.material());
  for (int i = 0; i <= kIntervals; ++i) {
    const double radius = tip + i * step_ * slope;
    const double energy = openedTo(radius, hole, scene.radius(), *material);
    if (!std::isfinite(energy)) {
      std::ostringstream message;
      message << "needle/tip/taper = " << scene.needle.tip.taper << " rad: " << i * step_
              << " m behind the tip the shaft is so wide that the material cannot be stretched around it; in a cell of "
              << 2 * scene.radius() << " m it may come there";
      throw ConfigError(message.str());
    }
    forces_.push_back(i == 0 ? energy : energy - forces_.front());
  }
  forces_.front() = 0;
}

double ShaftTaper::force(double depth) const {
  const double place = std::max(depth - dent_, 0.0) / step_;
  const int interval = std::min(static_cast<int>(place), kIntervals - 1);
  return forces_[interval] + (place - interval) * (forces_[interval + 1] - forces_[interval]);
}

}  // namespace microinjection
