#pragma once

#include "cell/mesh/mesh_config.h"

namespace microinjection {

constexpr double kTipRadius = 3e-6;       // m
constexpr double kContactRadius = 10e-6;  // m

/// A cell of 56 um under a needle on the vertical line through `offset` (m) and above a holding pipette: their circles
/// imprinted, five times finer in a ball of five needle diameters about the point of entry.
inline CellMeshConfig needleCell(const Eigen::Vector2d& offset = Eigen::Vector2d::Zero()) {
  CellMeshConfig config;
  config.radii = {28e-6};
  config.size = 12e-6;
  config.refinements = {{CellMeshConfig::Shape::kBall, offset, 5 * kTipRadius, +1, config.size / 5}};
  config.imprints = {{offset, kTipRadius, +1}, {Eigen::Vector2d::Zero(), kContactRadius, -1}};
  return config;
}

}  // namespace microinjection
