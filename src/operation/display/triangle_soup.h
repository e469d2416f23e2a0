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

}  // namespace microinjection
