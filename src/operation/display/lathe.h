#pragma once

#include <Eigen/Core>
#include <vector>

#include "operation/display/triangle_soup.h"

namespace microinjection {

/// Surface that a profile sweeps in a full turn about the z axis.
/// @param profile  points (r, z), r >= 0; walking along it with r to the right and z up, the outside is on the right.
/// @param segments  sides of the polygon that stands for the circle, at least 3.
TriangleSoup lathe(const std::vector<Eigen::Vector2d>& profile, int segments);

}  // namespace microinjection
