#pragma once

#include <Eigen/Core>
#include <vector>

#include "operation/display/triangle_soup.h"

namespace microinjection {

/// The surface that a profile sweeps in a full turn about the z axis.
/// @param profile   points (r, z), r >= 0; with r to the right and z up, the outside is on the
///                  right of its direction
/// @param segments  sides of the polygon that replaces the circle, at least 3
TriangleSoup lathe(const std::vector<Eigen::Vector2d>& profile, int segments);

}  // namespace microinjection
