#include "cell/model/shaft_taper.h"

#include <algorithm>
#include <cmath>

#include "cell/model/solved_branch.h"
#include "cell/penetration/hole_expansion.h"

namespace microinjection {
namespace {

constexpr int kIntervals = 48;  ///< of the cell's diameter

}  // namespace

ShaftTaper::ShaftTaper(const Scene& scene, double dent) : dent_(dent), step_(2 * scene.radius() / kIntervals) {
  const double tip = scene.needle.tip.radius, slope = std::tan(scene.needle.tip.taper);
  const double hole = steadyPenetration(scene).hole_radius * tip;
  const auto material = makeMaterial(scene.cell.material());
  for (int i = 0; i <= kIntervals; ++i) {
    const double radius = tip + i * step_ * slope;
    const HoleExpansion expansion(*material, std::max(scene.radius() / radius, 1.5));
    const double energy = radius * radius * expansion.at(hole / radius).energy;
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
