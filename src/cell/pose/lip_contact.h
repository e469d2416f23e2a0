#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cell/contact/pipette_mouth.h"

namespace microinjection {

/// Contact of a soft sphere with the end of a pipette: the whole circle of its lip, a part of it over which the sphere
/// tips, its flat end, its outside, or the wall of a wide bore.
///
/// The lip's core is a curve, so each length of it presses as a cylinder on a half-space does, (pi/4) E* times the
/// overlap per length (Popov, "Contact mechanics and friction", 2nd ed., ch. 5 and 17); over a patch this is 1.11 times
/// Hertz's force. The energy is the integral of this about the axis,
///
///     U = (pi/4) E* integral over psi of  (R - d(psi))^2 / 2  c dpsi,   where d < R
///
/// with d the distance of the sphere's centre from the pipette's wall in the half-plane at psi, and c the radius of the
/// lip's inner edge. (A cell that lies on the flat end or beside the tube, at the radius r, has the stiffness of the
/// patch times c / r: a weight that changed with r would be a force.) The angle psi begins at
/// the centre's own azimuth and ends where the contact ends, which has a closed form. So the points of the quadrature
/// move with the contact: U and its forces have no jumps, and none about the axis, however few points there are. Points
/// that are fixed to the lip would enter and leave the contact one by one while the cell tips.
class LipContact {
 public:
  static constexpr int kHalf = 10;  ///< points of the quadrature on each side of the azimuth
  static constexpr int kPoints = 2 * kHalf;

  /// @param contact_modulus Pa, E*
  LipContact(const PipetteMouth& mouth, double cell_radius, double contact_modulus);

  struct Point {
    double push = 0;                                   ///< N, on the sphere along `normal`
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit, out of the pipette
    double stiffness = 0;                              ///< N/m, of push over overlap
    double distance = 0;                               ///< m, of the centre from the core along `normal`
  };
  struct Forces {
    double energy = 0;                  ///< J
    double angle = 0;                   ///< rad, where the contact ends; pi: it is closed all round; 0: nothing touches
    std::array<Point, kPoints> points;  ///< of the contact when angle > 0
  };

  /// @param centre m, in the mouth's frame (PipetteMouth)
  Forces at(const Eigen::Vector3d& centre) const;

  /// m, (mean of the positive parts of (gap between sphere and the lip's inner edge)^(5/2) over the circle)^(2/5): the
  /// even gap that would leak as much. 0: closed.
  double leakingGap(const Eigen::Vector3d& centre) const;

 private:
  struct InHalfPlane;
  InHalfPlane inHalfPlane(double radial, double height, double cosine, double sine) const;
  double contactEnd(double radial, double height, bool edge_only) const;

  double reach_;          ///< m, sphere's radius and the lip's edge radius
  double inner_, outer_;  ///< m, the core's radii
  double lowest_;         ///< m, the core's end above the crest
  double side_;
  double foundation_;  ///< N/(m rad), force per angle and overlap
};

}  // namespace microinjection
