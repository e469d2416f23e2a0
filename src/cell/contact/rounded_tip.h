#pragma once

#include <Eigen/Core>
#include <string>

#include "cell/contact/rigid_surface.h"

namespace microinjection {

/// Rigid axisymmetric pipette with a rounded end: all points within `edge_radius` e of a solid
/// core. The core is a cylinder of radius c = radius - e about the axis without an upper end. The
/// pipette then has a flat end of radius c, a toroidal edge of radius e and a straight shaft. If e
/// is the whole radius, the core is a ray and the end a hemisphere. Frame of all points: origin at
/// the tip's lowest point on its axis, z along the shaft (out of the cell); metres.
///
///            z
///       |  | : |  |         shaft of radius c + e
///       |  | : |  |
///       |  +-:-+  |         z = e: lower end of the core, of radius c
///        \   :   /          edge: a torus of radius e
///         `--:--'           z = 0: flat end of radius c
///
/// A scene has rounded tips because the paper's sharp disc folds the surface under its edge: a neo-Hookean cell has a
/// converged force to 8 um there (elements of 0.4 um at the edge), and to 45 um under a hemisphere
/// (doc/reference/benchmarks.md, Where a converged force ends).
class RoundedTip : public RigidSurface {
 public:
  /// 0 < edge_radius <= radius, m; throws ConfigError otherwise.
  RoundedTip(double radius, double edge_radius);

  /// `shape` is hemisphere (which ignores edge_radius) or rounded_flat. Throws ConfigError for any
  /// other shape (a disc has a sharp edge) or a bad radius.
  static RoundedTip make(const std::string& shape, double radius, double edge_radius = 0);

  double radius() const { return core_radius_ + edge_radius_; }  ///< m, of the shaft
  double edgeRadius() const { return edge_radius_; }             ///< m
  double coreRadius() const { return core_radius_; }             ///< m, of the flat end; 0 for a hemisphere

  /// Signed distance to the surface, m, exact everywhere. Once continuously differentiable outside,
  /// and inside down to the depth e. Deeper, inside of the core, it has kinks where two faces are
  /// equally near.
  double distance(const Eigen::Vector3d& point) const override;

  /// distance() with its derivatives. In the core the normal points out through the nearest face.
  /// All values are finite: where the curvature is not defined (on the core's corner, on the axis
  /// deep in the shaft) it is large, and the normal is one of the possible ones. The curvature
  /// jumps between regions.
  Gap gap(const Eigen::Vector3d& point) const override;
  double size() const override { return radius(); }

  /// Height, m, of the tip's lowest point when the tip, moving down along z with its axis through
  /// (x, y) = `offset`, first touches a sphere of `cell_radius` about the origin. NaN when it
  /// passes the sphere: |offset| >= cell_radius + radius().
  double touchHeight(double cell_radius, const Eigen::Vector2d& offset) const;

  /// The first contact point on the sphere, m, in the frame of the sphere; on the axis of the
  /// sphere if the flat end touches. NaN when the tip passes the sphere.
  Eigen::Vector3d touchPoint(double cell_radius, const Eigen::Vector2d& offset) const;

 private:
  double core_radius_;
  double edge_radius_;
};

}  // namespace microinjection
