#pragma once

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

/// How a section becomes a mesh in space.
struct SweepConfig {
  int segments = 8;         ///< around the needle, >= 3; of a half: on it
  bool half = false;        ///< only the half y >= 0, for what is symmetric in the plane y = 0; needs pole_azimuth = 0
  double pole_offset = 0;   ///< m, distance of the needle's place on the upper surface from the z axis
  double pole_azimuth = 0;  ///< rad, its direction from the x axis
  double disc_radius = 0;  ///< m: the section's vertex at this distance from the axis comes to lie on the curve at this
                           ///< distance from the vertical line through the pole; 0: no disc
  double holding_radius = 10e-6;  ///< m: below, what lies within this distance from the z axis stays there
};

/// Mesh in space of a ball of layers whose elements are ordered around the needle's place: the section turned about the
/// z axis, its pole then moved to the needle's place by turning each cone about the centre, less and less towards the
/// holding pipette, which stays in place. Prisms are cut into tetrahedra. All nodes keep their distance from the
/// centre, so that layers stay spheres. Against unstructured meshes of the same size the error of the force is several
/// times smaller, since nearly all of the solution's variation is across the needle's edge, not along it.
/// The cut of a half is no part of its facets.
/// Throws std::invalid_argument when the pole is so far out that elements would be inverted.
QuadraticMesh<3> sweepSection(const QuadraticMesh<2>& section, const SweepConfig& config);

}  // namespace microinjection
