#pragma once

#include <Eigen/Core>

namespace microinjection {

/// What a rigid sphere that suction holds to a lip can bear, quasi-statically. The lip's circle has the radius s =
/// R sin(alpha); suction draws the sphere to its middle with F = p pi s^2. The contact's normals pass through the
/// sphere's centre, and their sum N = F / cos(alpha) needs no friction. Limits of a load through the centre:
///
/// - along the tube: F. Friction adds nothing, since the contact is gone.
/// - across it: the push over the lip grows as 1 + k cos(phi) with an even foundation, and the seal opens on one side
///   where k = 1, at F tan(alpha) / 2. The sphere tips over the lip's far point when all of N is there, at F
///   tan(alpha); tipping is rolling about this point, so friction does not resist it.
///
/// Of a load beside the centre, friction (Coulomb's, mu) also bears the moment. Turning in its seat about an axis
/// across the tube, the sphere slides at sqrt(cos^2(alpha) + sin^2(alpha) cos^2(phi)), whose mean over the circle is 2
/// E(sin(alpha)) / pi, E the complete elliptic integral of the second kind. So friction bears the moment mu N R 2 E /
/// pi, and mu N s about the tube.
///
/// A soft cell bulges into the bore, so that it leaves the lip at a circle nearer to the bore, of the radius r < s
/// (LipSuction::releasedRadius). Pulling off and tipping are about that circle: s becomes r in their limits, and F
/// becomes p pi r^2. It turns while it is pressed, about the circle s. Meanwhile friction pushes it across the tube,
/// against the way of its material at the lip, by h M of the moment M, h = cos(alpha) <1/g> / (R <g>), g the speed
/// above over that of the material and < > the mean over the circle. Its centre yields by h M / k, k the seat's lateral
/// stiffness, towards a needle that presses, whose arm m about the unloaded centre becomes shorter. So
///
///     f (m - h M / k) = M,  M = (F + f) turning / F        f: of a load along the tube, into the pipette
///
/// is quadratic in f, and has no solution where the seat wedges: such a needle does not turn the cell. Under a load
/// that pulls the arm becomes longer. The shift is at most that at which the push on one side of the lip vanishes, with
/// friction above tan(alpha) / (2 <1/g>): from there on the seal opens at that side, and the seat is no longer linear.
/// `./dev bench slip` compares with solved cells.
///
/// Each limit is exact when the others are far; friction that already bears a moment in one direction bears less in
/// another.
class HoldLimits {
 public:
  /// A rigid sphere. @param suction N, F >= 0. @param seal_radius m, s, below @param radius m, the sphere's. @param
  /// friction mu
  HoldLimits(double suction, double seal_radius, double radius, double friction);
  struct SoftSeat {
    double released_radius;    ///< m, r, above 0 and at most s
    double lateral_stiffness;  ///< N/m, > 0, of a shift across the tube; infinite: the cell stays
  };
  /// A soft one.
  HoldLimits(double suction, double seal_radius, double radius, double friction, const SoftSeat& seat);

  double suction() const { return suction_; }  ///< N, F
  double pull() const;                         ///< N, along the tube: the cell comes off
  double opening() const;                      ///< N, across the tube through the centre: the seal opens on one side
  double sideways() const;                     ///< N, so that the cell comes off over the lip
  double turning() const;                      ///< N m, about an axis across the tube: the cell turns in its seat
  double spinning() const;                     ///< N m, about the tube
  /// N, across the tube at the sphere's pole opposite to the mouth, where a needle touches it: the first that happens
  /// of turning and tipping.
  double atPole() const;

  /// N, the largest force of this direction (any length) at this point, m: the first limit of pulling off, tipping
  /// over the lip, turning and spinning. Infinite when the force only presses the cell into the lip, or wedges it
  /// there. Both in a frame at the centre of the unloaded sphere, whose z points along the tube into the pipette.
  double largest(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;

 private:
  double turningLoad(double arm, double along) const;  ///< N, see largest()

  double suction_, seal_, radius_, friction_;
  SoftSeat seat_;
};

}  // namespace microinjection
