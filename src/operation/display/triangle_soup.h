#pragma once

#include <Eigen/Core>
#include <vector>

#include "operation/display/colour_map.h"

namespace microinjection {

/// Triangles for a renderer: three points each, counterclockwise as seen from outside.
struct TriangleSoup {
  std::vector<Eigen::Vector3d> points;  ///< display units
  std::vector<Colour> colours;          ///< one per point, or empty: the renderer's own colour

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
    points.push_back(a);
    points.push_back(b);
    points.push_back(c);
  }
};

/// Segments of two points each; display units.
using LineList = std::vector<Eigen::Vector3d>;

/// The surface that a profile sweeps in a full turn about the z axis.
/// @param profile   points (r, z), r >= 0; with r to the right and z up, the outside is on the
///                  right of its direction
/// @param segments  sides of the polygon that replaces the circle, at least 3
TriangleSoup lathe(const std::vector<Eigen::Vector2d>& profile, int segments);

}  // namespace microinjection
