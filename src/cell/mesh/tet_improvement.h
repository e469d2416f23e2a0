#pragma once

#include <vector>

#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Where a vertex may go while a mesh is improved.
struct Mobility {
  enum class Kind { kFixed, kOnSphere, kFree };
  Kind kind = Kind::kFixed;
  double radius = 0;  ///< m, of the sphere about the origin
};

/// Moves vertices of tetrahedra whose radiusRatio is below `target` so that the worst one around each gets better,
/// where it can, by less than their shortest edge. A mesher's own improvement holds surfaces still, and slivers remain
/// between them. `mobility`: of each vertex. Keeps the connectivity; deterministic.
void improveWorstTetrahedra(TetMesh& mesh, const std::vector<Mobility>& mobility, double target);

}  // namespace microinjection
