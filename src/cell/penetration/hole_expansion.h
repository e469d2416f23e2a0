#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/material/material.h"

namespace microinjection {

/// A long hole that a shaft has opened in a block: the state far behind the tip of a needle that has pierced a solid
/// (Shergold and Fleck, "Mechanisms of deep penetration of soft solids, with application to the injection and wounding
/// of skin", Proc. R. Soc. A 460, 2004). The block is deformed in the planes across the shaft only.
///
/// A circle of undeformed radius rho has the radius r(rho) behind. The unknown is q = r^2 - rho^2, which is constant in
/// an incompressible solid, so that piecewise linear functions of ln rho neither lock nor lose a hole that is opened to
/// many times its radius:
///
///     stretches  r / rho,  J rho / r,  1     with  J = 1 + (dq / d rho) / (2 rho)
///     energy     per undeformed length  2 pi  integral of W rho d rho,  at its minimum with q = R^2 - b^2 at the hole
///
/// Lengths are in radii R of the shaft.
class HoleExpansion {
 public:
  struct State {
    double energy = 0;    ///< Pa, per undeformed length and R^2; infinite where the material cannot be stretched so far
    double pressure = 0;  ///< Pa, of the wall on the shaft, per deformed area
  };

  /// `outer`: undeformed radius of the block, > 1. `material` must outlive this.
  explicit HoleExpansion(const Material& material, double outer = 1000);

  /// Of a hole of the undeformed radius `radius`, in (0, 1]. Throws std::runtime_error when no equilibrium is found.
  State at(double radius) const;

 private:
  struct Circle;
  double energyOf(const Eigen::VectorXd& q, const std::vector<double>& places) const;

  const Material& material_;
  double outer_;
};

}  // namespace microinjection
