#pragma once

#include <Eigen/Core>

namespace microinjection {

/// Distance of a point from the surface of a rigid body, with its derivatives.
struct Gap {
  double distance = 0;                                  ///< m, > 0 outside of the body
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();     ///< gradient of the distance: unit, out of the body
  Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();  ///< its Hessian, 1/m; symmetric, curvature * normal = 0
};

/// Rigid axisymmetric pipette that a cell touches: a needle's end, or a mouth. It is given by the exact distance of any
/// point (m, in the pipette's frame: z along its axis), not by triangles: Newton's method needs gap, normal and
/// curvature of a contact, and facets would make the normal jump at each of their edges while the cell slides over
/// them.
class RigidSurface {
 public:
  virtual ~RigidSurface() = default;

  /// Signed distance to the surface, m.
  virtual double distance(const Eigen::Vector3d& point) const = 0;
  /// distance() with its derivatives; all values are finite.
  virtual Gap gap(const Eigen::Vector3d& point) const = 0;
  /// m, the size of the part that the cell meets: what gaps and penetrations are compared with.
  virtual double size() const = 0;
};

}  // namespace microinjection
