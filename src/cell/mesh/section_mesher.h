#pragma once

#include "cell/mesh/mesh_config.h"
#include "cell/mesh/triangle_mesh.h"

namespace microinjection {

/// Makes the mesh with gmsh, conforming across the layers. Every arc has at least 8 elements.
/// Vertices of the arcs lie on their circle and those of the axis at r = 0, to rounding; the named
/// points are vertices. The same configuration gives the same mesh. Throws ConfigError on a bad
/// configuration, std::runtime_error when gmsh fails. Calls are serialised, because gmsh has global
/// state.
TriangleMesh makeSectionMesh(const SectionMeshConfig& config);

}  // namespace microinjection
