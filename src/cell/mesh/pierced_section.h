#pragma once

#include <limits>
#include <vector>

#include "cell/mesh/quadratic_mesh.h"

namespace microinjection {

/// A ball's section with a hole along the axis, open at the upper pole. Metres.
struct PiercedSectionConfig {
  std::vector<double> radii = {28e-6};  ///< m, outer radius of each layer, outermost first
  double hole_radius = 1e-6;            ///< m
  double hole_length = 10e-6;           ///< m, from the pole; 0: no hole
  double rim_radius = 0;                ///< m, fillet of the hole's rim
  double contact_radius = 3e-6;  ///< m, of the surface about the pole that needs elements as small as at the hole's rim
  double held_radius = 5e-6;     ///< m, distance from the axis of a point of the lower surface that is a vertex
  double hole_size = 0.5e-6;     ///< m, elements at the hole
  /// m, of the hole, from the pole, that needs them
  double fine_length = std::numeric_limits<double>::infinity();
  double held_size = 1e-6;  ///< m, elements at that point
  double size = 6e-6;       ///< m, of the largest elements
  double growth = 0.25;     ///< of the size per distance, in (0, 1]

  /// Throws ConfigError with all errors at once.
  void validate() const;

  /// Whether a hole of this length (m) ends so close to a border between layers that elements there have no room.
  bool endsAtBorder(double length) const;
};

/// Made with gmsh, conforming across the layers. The facets are those of the layers' spheres, whose midpoints are on
/// them, and those of the hole, which are straight and `outer`; their layer is that of the element. Throws ConfigError
/// on a bad configuration, std::runtime_error when gmsh fails.
QuadraticMesh<2> makePiercedSection(const PiercedSectionConfig& config);

}  // namespace microinjection
