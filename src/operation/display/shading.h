#pragma once

#include <Eigen/Core>

#include "operation/display/colour_map.h"

namespace microinjection {

/// Brightness, about 1, of a surface with this outward unit normal under a lamp above the viewer's left shoulder (the
/// viewer looks along y). Never dark, so that a colour keeps its meaning. rviz itself does not light triangles that
/// have colours of their own.
double lampLight(const Eigen::Vector3d& normal);

/// The colour with its brightness multiplied by `light` (>= 0), clamped; the opacity stays.
Colour shaded(const Colour& colour, double light);

}  // namespace microinjection
