#pragma once

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

/// A homogeneous ball's section with a hole along the axis, open at the upper pole. Metres.
struct PiercedSectionConfig {
  double radius = 28e-6;         ///< m, of the ball
  double hole_radius = 1e-6;     ///< m
  double hole_length = 10e-6;    ///< m, from the pole; 0: no hole
  double contact_radius = 3e-6;  ///< m, of the surface about the pole that needs elements as small as at the hole's rim
  double held_radius = 5e-6;     ///< m, distance from the axis of a point of the lower surface that is a vertex
  double hole_size = 0.5e-6;     ///< m, elements at the hole
  double held_size = 1e-6;       ///< m, elements at that point
  double size = 6e-6;            ///< m, of the largest elements
  double growth = 0.25;          ///< of the size per distance, in (0, 1]

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// Made with gmsh. The facets are those of the ball, whose midpoints are on it, and those of the hole, which are
/// straight; all have the layer 0. Throws ConfigError on a bad configuration, std::runtime_error when gmsh fails.
QuadraticMesh<2> makePiercedSection(const PiercedSectionConfig& config);

}  // namespace microinjection
