#pragma once

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

/// How a section is swept into a mesh in space.
struct SweepConfig {
  int segments = 8;         ///< around the needle, >= 3; of a half mesh: in it
  bool half = false;        ///< only the half y >= 0, for symmetry in the plane y = 0; needs pole_azimuth = 0
  double pole_offset = 0;   ///< m, distance of the contact point on the upper surface from the z axis
  double pole_azimuth = 0;  ///< rad, direction of the contact point from the x axis
  /// m: the section's vertex at this distance from the axis is moved to this distance from the
  /// vertical line through the pole; 0: no disc.
  double disc_radius = 0;
  /// m: on the lower half, points within this distance from the z axis are not moved.
  double holding_radius = 10e-6;
};

/// Mesh in space of a ball of layers whose elements are ordered around the contact point. The
/// section is swept about the z axis. The pole is then moved to the contact point by tilting each
/// cone about the centre, less and less towards the holding pipette, which stays in place. Prisms
/// are cut into tetrahedra. All nodes keep their distance from the centre, so that layers stay
/// spheres. The force error is several times smaller than that of unstructured meshes of the same
/// size, because the solution varies across the tip's edge and hardly along it. The facets of a
/// half mesh do not include the cut. Throws std::invalid_argument when the pole is so far out that
/// elements would be inverted.
QuadraticMesh<3> sweepSection(const QuadraticMesh<2>& section, const SweepConfig& config);

}  // namespace microinjection
