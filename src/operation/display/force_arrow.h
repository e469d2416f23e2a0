#pragma once

#include <Eigen/Core>
#include <optional>

#include "operation/display/display_scale.h"

namespace microinjection {

/// An arrow in display units.
struct Arrow {
  Eigen::Vector3d tail;
  Eigen::Vector3d head;
  double shaft_diameter = 0;
  double head_diameter = 0;
  double head_length = 0;
};

/// The arrow of a force; empty when it is too short to be visible.
/// @param tail   m, where the arrow starts
/// @param force  N, in the frame of `tail`
/// @param scale  m/N, the arrow's length in the scene per newton, before the enlargement
std::optional<Arrow> forceArrow(const Eigen::Vector3d& tail, const Eigen::Vector3d& force, double scale,
                                double enlargement = kDisplayScale);

}  // namespace microinjection
