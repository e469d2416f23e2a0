#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "operation/display/cell_surface.h"

namespace microinjection {

/// The border between a layer of the cell and the one outside of it.
struct LayerBorder {
  int layer = 1;                              ///< 1 for the second layer from outside
  std::vector<Eigen::Vector3d> vertices;      ///< m, deformed
  std::vector<std::array<int, 3>> triangles;  ///< closed
  bool estimated = false;                     ///< not solved: to first order in the layer's thickness, or at rest

  bool drawable() const;  ///< finite, with indices that fit
};

/// Border below an outermost layer of this thickness (m), to first order in it.
/// @param columns  F N of the layer at each vertex (1), see SurfaceStressField; where it is not
///                 known, that of the rest position
LayerBorder borderBelow(const CellSurface& surface, const std::vector<Eigen::Vector3d>& columns, double thickness);

/// A concentric sphere as it is without a needle.
/// @param share   of the cell's radius
/// @param centre  m, of the cell at rest
LayerBorder borderAtRest(const CellSurface& surface, int layer, double share, const Eigen::Vector3d& centre);

}  // namespace microinjection
