#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mesh/surface_mesh.h"

namespace microinjection {

/// The vertices that stick to a flat needle tip and move with it as one rigid, translating disc.
struct TipPatch {
  std::vector<int> vertices;  ///< of the TetMesh, ascending, never empty
};

/// Vertices of `surface` on its near side (outward direction . axis > 0) within `radius` of the line through `point`
/// along `axis`, which points out of the body, whose centre is the origin and which is star-shaped about it. A relative
/// tolerance of 1e-6 counts the vertices that the mesher put on the circle as within. When the mesh is too coarse for
/// any vertex to lie there: the corners of the triangle that the line hits first from outside, or else, off the body,
/// the vertex nearest to `point`. Lengths in metres.
TipPatch findTipPatch(const SurfaceMesh& surface, const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                      double radius);

}  // namespace microinjection
