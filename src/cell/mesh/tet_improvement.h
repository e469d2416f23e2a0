#pragma once

#include <vector>

#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Where a vertex may move while a mesh is improved.
struct Mobility {
  enum class Kind { kFixed, kOnSphere, kFree };
  Kind kind = Kind::kFixed;
  double radius = 0;  ///< m, of the sphere about the origin
};

/// Moves vertices of tetrahedra whose radiusRatio is below `target`, by less than their shortest
/// edge, to improve the worst tetrahedron around each of them. A mesher's own improvement keeps
/// surfaces fixed, so that slivers remain between them. `mobility`: of each vertex. Keeps the
/// connectivity; deterministic.
void improveWorstTetrahedra(TetMesh& mesh, const std::vector<Mobility>& mobility, double target);

}  // namespace microinjection
