#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mesh/surface_mesh.h"

namespace microinjection {

/// Vertices that stick to a flat needle tip and move with it as one rigid, translating disc.
struct TipPatch {
  std::vector<int> vertices;  ///< of the TetMesh, ascending, never empty
};

/// Vertices of `surface` on its near side (outward direction . axis > 0) within `radius` of the
/// line through `point` along `axis`. The axis points out of the body, which is star-shaped about
/// the origin. The relative tolerance of 1e-6 includes the vertices that the mesher placed on the
/// circle. If the mesh is too coarse for any vertex there, the result is the corners of the first
/// triangle that the line hits from outside, or, if it misses the body, the vertex nearest to
/// `point`. Lengths in metres.
TipPatch findTipPatch(const SurfaceMesh& surface, const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                      double radius);

}  // namespace microinjection
