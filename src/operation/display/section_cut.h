#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "operation/display/triangle_soup.h"

namespace microinjection {

/// Cuts a body open: what is on the side of the normal is removed.
struct CutPlane {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitY();  ///< unit

  /// Through `point`, containing `axis` (unit), and facing a viewer who looks along y as far as it
  /// can.
  static CutPlane along(const Eigen::Vector3d& point, const Eigen::Vector3d& axis);
  double height(const Eigen::Vector3d& at) const { return normal.dot(at - point); }
};

/// What remains of coloured triangles, and of segments.
TriangleSoup remains(const TriangleSoup& soup, const CutPlane& plane);
LineList remains(const LineList& lines, const CutPlane& plane);

/// The longest closed curve in which a closed surface meets the plane; empty: they do not meet.
std::vector<Eigen::Vector3d> outline(const std::vector<Eigen::Vector3d>& vertices,
                                     const std::vector<std::array<int, 3>>& triangles, const CutPlane& plane);

/// The inside of a closed curve in the plane, in one colour, and the curve itself as segments.
TriangleSoup inside(const std::vector<Eigen::Vector3d>& curve, const CutPlane& plane, const Colour& colour);
LineList segments(const std::vector<Eigen::Vector3d>& curve);

}  // namespace microinjection
