#include "hardware/devices/axis_speeds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

constexpr double kSlower = 0.8;  // share of the wanted speed that is enough if the line is kept better

/// It is largest when one of the axes arrives.
double deviationOf(const Eigen::Vector3d& displacement, const Eigen::Vector3d& speeds) {
  const Eigen::Vector3d line = displacement.normalized();
  double furthest = 0;
  for (int i = 0; i < 3; ++i) {
    if (displacement[i] == 0) continue;
    const double time = std::abs(displacement[i]) / speeds[i];
    const Eigen::Vector3d travelled =
        displacement.array().sign().matrix().cwiseProduct((speeds * time).cwiseMin(displacement.cwiseAbs()));
    furthest = std::max(furthest, (travelled - line * line.dot(travelled)).norm());
  }
  return furthest;
}

}  // namespace

AxisSpeeds straightSpeeds(const Eigen::Vector3d& displacement, double speed, const Eigen::Vector3d& most,
                          double good_enough, const std::function<double(double)>& nearest) {
  const Eigen::Vector3d wanted = displacement.cwiseAbs().normalized() * speed;
  const auto rounded = [&](double part) {
    Eigen::Vector3d speeds = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) {
      if (displacement[i] != 0) speeds[i] = nearest(std::min(wanted[i] * part, most[i]));
    }
    return speeds;
  };
  AxisSpeeds best;
  best.speeds = rounded(1);
  best.deviation = std::numeric_limits<double>::infinity();
  for (double part = 1; part > kSlower && best.deviation > good_enough; part -= 0.02) {
    const Eigen::Vector3d each = rounded(part);
    if (each.norm() > 1.001 * wanted.norm() || deviationOf(displacement, each) >= best.deviation) continue;
    best.speeds = each;
    best.deviation = deviationOf(displacement, each);
  }
  best.deviation = deviationOf(displacement, best.speeds);
  for (int i = 0; i < 3; ++i) {
    if (displacement[i] != 0) best.duration = std::max(best.duration, std::abs(displacement[i]) / best.speeds[i]);
  }
  return best;
}

}  // namespace microinjection
