#pragma once

#include "cell/mesh/quadratic_mesh.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Meshes of a scene for converged solutions, graded towards where its needle and its holding pipette make the stress
/// singular or move the contact. `level` counts how often the elements at the needle are halved; it may be a fraction,
/// and -1 is the coarsest for converged ones. Size of the elements at the needle's edge (disc) or under its end
/// (rounded), m.
double edgeSize(const Scene& scene, double level);

/// Of the section (Dim 2; the needle's offset does not count), or in space (Dim 3): see sweepSection.
template <int Dim>
QuadraticMesh<Dim> makeSceneMesh(const Scene& scene, double level);

/// The half y >= 0 of the mesh in space of a scene whose needle's place is on the x axis: see CellProblem's Symmetry.
/// Its nodes and their mirror images are those of the whole mesh.
QuadraticMesh<3> makeHalfSceneMesh(const Scene& scene, double level);

/// That in space from its section: makeSceneMesh<3>(scene, level) without gmsh, whatever the needle's offset.
QuadraticMesh<3> sweepScene(const Scene& scene, const QuadraticMesh<2>& section, double level);

/// Offset and lateral motion leave the scene one of revolution.
bool isAxisymmetric(const Scene& scene);

}  // namespace microinjection
