#pragma once

#include <Eigen/Core>

#include "operation/display/colour_map.h"

namespace microinjection {

/// Brightness (about 1) of a surface with this outward unit normal, for a lamp above the left
/// shoulder of a viewer who looks along y. It is never dark, so that colours stay recognisable.
/// rviz does not light triangles with individual colours.
double lampLight(const Eigen::Vector3d& normal);

/// The colour with its brightness multiplied by `light` (>= 0), clamped; the opacity stays.
Colour shaded(const Colour& colour, double light);

}  // namespace microinjection
