#pragma once

#include <Eigen/Core>

#include "cell/contact/rigid_surface.h"

namespace microinjection {

/// Rigid mouth of a hollow pipette: a tube with a rounded lip, all points within `edge_radius` e of a tubular core.
/// Frame of all points: origin in the plane of the lip's crest, on the axis; z along the tube, away from the cell;
/// metres. `side` is +1 for a pipette above the cell; for one below, -1, z of the points is mirrored.
///
///            z    bore of          wall
///            :    inner_radius a  |    |
///            :                    |    |     core: a + e <= r <= b - e, z >= e
///            :                     `--'      z = 0: crest of the lip
///            +....................a....b...... r
///
class PipetteMouth : public RigidSurface {
 public:
  /// 0 < inner_radius < outer_radius, 0 < edge_radius <= half of the wall, m, and side +1 or -1; throws
  /// std::invalid_argument otherwise.
  PipetteMouth(double inner_radius, double outer_radius, double edge_radius, double side);

  double innerRadius() const { return inner_radius_; }                 ///< m, of the bore
  double outerRadius() const { return outer_radius_; }                 ///< m
  double edgeRadius() const { return edge_radius_; }                   ///< m
  double crestRadius() const { return inner_radius_ + edge_radius_; }  ///< m, of the inner edge of the lip's crest
  double side() const { return side_; }

  /// Exact everywhere. Kinks lie on the bore's axis and within the core, deeper than the edge's radius.
  double distance(const Eigen::Vector3d& point) const override;
  Gap gap(const Eigen::Vector3d& point) const override;
  double size() const override { return edge_radius_; }

  /// Where the mouth, coming along its axis, first touches a sphere about a point of the axis: a circle.
  /// @pre the sphere is wider than the bore
  double touchRadius(double cell_radius) const;  ///< m, of that circle
  /// m, distance of the lip's crest from the sphere's centre along the axis, then
  double touchDistance(double cell_radius) const;

 private:
  double inner_radius_, outer_radius_, edge_radius_, side_;
};

}  // namespace microinjection
