#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "vision/microscope/microscope_scene.h"

namespace microinjection {

/// Returns the outline of a surface of triangles in the plane of constant `y` (m): what the
/// microscope shows of a deformed cell. `nodes`: m, in the world; `triangles`: indices of nodes. Of
/// several closed curves it is the one with the largest area. Empty when the plane meets no closed
/// curve. Throws ConfigError for an index without a node.
CellOutline sectionOutline(const std::vector<Eigen::Vector3d>& nodes, const std::vector<std::array<int, 3>>& triangles,
                           double y);

/// Returns the outline `distance` (m) inside another one: the inner border of a layer of constant
/// thickness. Each corner moves along the mean normal of its two sides. Negative distances are
/// outside. The radius of every bend must be larger than the distance.
CellOutline insetOutline(const CellOutline& outline, double distance);

}  // namespace microinjection
