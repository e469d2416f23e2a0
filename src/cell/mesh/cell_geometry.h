#pragma once

#include <vector>

#include "cell/mesh/circle_on_sphere.h"

namespace microinjection {

/// Builds a ball of concentric layers in the current gmsh session, in units of its radius. `radii`:
/// of the layers, outermost first; the first is 1. `circles`: curves on the surface that become
/// edges of the geometry, within 0.95 of the z axis. `flattening`: divides all heights (z). Returns
/// gmsh's volumes, outermost first.
std::vector<int> buildCellGeometry(const std::vector<double>& radii, const std::vector<CircleOnSphere>& circles,
                                   double flattening);

/// The circle that gmsh's curve was made for; null for the seams between the pieces of a sphere.
const CircleOnSphere* imprintedCircle(int curve, const std::vector<CircleOnSphere>& circles, double flattening);

}  // namespace microinjection
