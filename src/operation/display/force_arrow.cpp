#include "operation/display/force_arrow.h"

#include <algorithm>

namespace microinjection {

std::optional<Arrow> forceArrow(const Eigen::Vector3d& tail, const Eigen::Vector3d& force, double scale,
                                double enlargement) {
  constexpr double kShortest = 2e-3, kShaft = 0.014, kHead = 0.036, kHeadLength = 0.05;  // display units
  const Eigen::Vector3d shaft = toDisplay(scale * force, enlargement);
  const double length = shaft.norm();
  if (!(length >= kShortest)) return std::nullopt;
  // A short arrow keeps its shape: its head is half of it and all sizes shrink alike.
  const double shrink = std::min(1.0, length / (2 * kHeadLength));
  const Eigen::Vector3d start = toDisplay(tail, enlargement);
  return Arrow{start, start + shaft, shrink * kShaft, shrink * kHead, shrink * kHeadLength};
}

}  // namespace microinjection
