#pragma once

#include <Eigen/Core>
#include <string>

#include "mesh/tet_mesh.h"

namespace microinjection {

/// What determines the mesh of a cell: a sphere about the origin, refined where the needle enters from above.
struct CellMeshConfig {
  double diameter = 56e-6;       ///< m
  double size = 12e-6;           ///< m, of elements outside of the puncture zone
  double density = 5;            ///< elements in the puncture zone are this many times smaller, >= 1
  double zone_diameter = 30e-6;  ///< m, of the puncture zone: a ball about the point of entry
  double tip_radius = 3e-6;      ///< m, of the disc under the tip
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< m, (x, y) of the needle's line, along z
  double contact_radius = 10e-6;                     ///< m, of the holding pipette's circle

  /// Throws ConfigError with all errors at once.
  void validate() const;

  /// Where the needle's line meets the upper surface, m.
  Eigen::Vector3d entry() const;

  /// Wanted element size at a point, m: size / density in the puncture zone, growing by a third of the distance
  /// outside of it up to `size`.
  double sizeAt(const Eigen::Vector3d& point) const;
};

/// Makes the mesh with gmsh. Edges follow the circle of the tip (distance tip_radius from the needle's line, upper
/// surface) and of the holding pipette (distance contact_radius from the z axis, lower surface); all vertices of the
/// surface lie on the sphere, and those of the circles on them, to rounding. The same configuration gives the same
/// mesh. Throws ConfigError on a bad configuration, std::runtime_error when gmsh fails. Serialised: gmsh is global.
TetMesh makeCellMesh(const CellMeshConfig& config);

/// Version of gmsh and of this mesher: a mesh is a function of this and of its configuration.
std::string mesherVersion();

}  // namespace microinjection
