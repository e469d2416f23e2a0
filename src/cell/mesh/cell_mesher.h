#pragma once

#include <string>

#include "cell/mesh/cell_mesh_config.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Makes the mesh with gmsh: concentric layers whose interfaces are spheres, a conforming mesh across them, sizes as
/// SizeField (cell/mesh/size_field.h) wants them, or up to 8 % smaller where that avoids bad elements. Edges follow
/// each imprinted circle, 8 at least. All vertices of the surface and of the interfaces lie on their sphere, and those
/// of the circles on them, to rounding. The same configuration gives the same mesh. Throws ConfigError on a bad
/// configuration, std::runtime_error when gmsh fails. Serialised: gmsh is global.
TetMesh makeCellMesh(const CellMeshConfig& config);

/// Version of gmsh and of this mesher: a mesh is a function of this and of its configuration.
std::string mesherVersion();

}  // namespace microinjection
