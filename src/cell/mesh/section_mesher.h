#pragma once

#include "cell/mesh/section_mesh_config.h"
#include "cell/mesh/triangle_mesh.h"

namespace microinjection {

/// Makes the mesh with gmsh, conforming across the layers. Every arc has 8 elements at least. Vertices of the arcs lie
/// on their circle, those of the axis at r = 0, and the named points are vertices, to rounding. The same configuration
/// gives the same mesh. Throws ConfigError on a bad configuration, std::runtime_error when gmsh fails. Serialised:
/// gmsh is global.
TriangleMesh makeSectionMesh(const SectionMeshConfig& config);

}  // namespace microinjection
