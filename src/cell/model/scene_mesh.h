#pragma once

#include "cell/mesh/quadratic_mesh.h"
#include "cell/model/scene.h"

namespace microinjection {

/// Meshes of a scene for converged solutions, refined where the needle and the holding pipette make
/// the stress singular or the contact moves. `level` is the number of times that the elements at
/// the needle are halved; it may be a fraction, and -1 is the coarsest for converged solutions.
/// edgeSize: size of the elements at the needle's edge (disc) or under its end (rounded), m.
double edgeSize(const Scene& scene, double level);

/// Mesh of the section (Dim 2; ignores the needle's offset), or in space (Dim 3): see sweepSection.
template <int Dim>
QuadraticMesh<Dim> makeSceneMesh(const Scene& scene, double level);
template <>
QuadraticMesh<2> makeSceneMesh<2>(const Scene& scene, double level);
template <>
QuadraticMesh<3> makeSceneMesh<3>(const Scene& scene, double level);

/// The half y >= 0 of the mesh in space of a scene whose contact point is on the x axis: see
/// CellProblem's Symmetry. Its nodes and their mirror images are those of the whole mesh.
QuadraticMesh<3> makeHalfSceneMesh(const Scene& scene, double level);

/// The mesh in space from its section: makeSceneMesh<3>(scene, level) without gmsh, for any needle
/// offset.
QuadraticMesh<3> sweepScene(const Scene& scene, const QuadraticMesh<2>& section, double level);

/// Whether the scene is a body of revolution, that is, has no needle offset.
bool isAxisymmetric(const Scene& scene);

}  // namespace microinjection
