#pragma once

#include <string>

#include "cell/mesh/mesh_config.h"
#include "cell/mesh/tet_mesh.h"

namespace microinjection {

/// Makes a mesh of concentric layers with gmsh. It conforms across the spherical interfaces.
/// Element sizes are those of SizeField (cell/mesh/size_field.h), or up to 8 % smaller where that
/// avoids bad elements. Each imprinted circle has at least 8 edges. Vertices on spheres and
/// imprinted circles are exact to rounding. The same configuration gives the same mesh. Throws
/// ConfigError on a bad configuration, std::runtime_error when gmsh fails. Calls are serialised,
/// because gmsh has global state.
TetMesh makeCellMesh(const CellMeshConfig& config);

/// Version of gmsh and of this mesher. A mesh depends on it and on its configuration only.
std::string mesherVersion();

}  // namespace microinjection
