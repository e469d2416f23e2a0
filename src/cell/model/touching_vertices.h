#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cell/model/scene.h"

namespace microinjection {

/// Vertices of a deformed surface that touch an upright tip: those closer to it than a twentieth of
/// its radius, or inside of it. A surface that was interpolated does not lie exactly on the tip.
/// @param position  m, of the tip's lowest point, or of a disc's centre
std::vector<std::uint32_t> touchingVertices(const Scene::Tip& tip, const Eigen::Vector3d& position,
                                            const std::vector<Eigen::Vector3d>& vertices);

}  // namespace microinjection
