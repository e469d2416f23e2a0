#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "cell/surrogate/jet.h"

namespace microinjection {

/// Units of the expansion's variables.
struct EnergyScales {
  double angle = 1.0471975511965976;  ///< rad, of the contact point from the pole
  double length = 20e-6;              ///< m, longest displacement of the tip
  double energy = 1e-12;              ///< J
};

struct EnergyDegrees {
  int angle = 4;      ///< in the contact angle, even
  int direction = 6;  ///< in the displacement's direction
  int distance = 7;   ///< in the square root of its length
  int root = 2;       ///< power of the length in every term: 2 for an energy, 1 for a force
};

/// Stored energy of a cell of revolution as a function of the contact point and of the tip's
/// displacement since.
///
/// The tip's displacement u is in the contact frame: x away from the axis of the cell, z along the
/// needle, out of the cell. With t = |u| / length, s = sqrt(t), a = u_x / |u|, w = 1 + u_z / |u|
/// and c = angle / scale:
///
///     E = energy t^2 sum_(i, j, k, n) C_ijkn (c^2)^i (c a)^j w^k T_n(2 s / s_max - 1)
///
/// These are all smooth functions of two plane vectors, the contact point and the lateral
/// displacement, that are invariant when both are rotated or mirrored together; polynomials in a
/// and w are the spherical harmonics. t^2 and powers of s represent both a sticking patch (E ~ t^2
/// at first) and a round tip (t^(5/2), Hertz). For a force, t replaces t^2 and N replaces J.
///
/// Depth and lateral motion have one unit, `length`, because units of their own ranges would make all real directions
/// steep ones: on a path that was left out of the fit the force was then off by 10 % instead of 1 %. The overlap of the
/// tip with the cell at rest says too little as a variable, since a sticking tip drags the surface along
/// (doc/design/surrogate_cell.md, What was tried). The expansion is linear in its coefficients, so a fit is one
/// least-squares problem (energy_fit.h), and the members of a family are interpolated coefficient by coefficient.
///
/// Coefficients, with the default degrees (50 terms of 8 each):
///
///     coefficients_   | term (i, j, k): n = 0 .. distance | next term ... |       all contact points
///                              | makeLocal(): sum over i at one angle
///                              v
///     Local           column (j, k): n = 0 .. distance (rows), 25 columns         one contact point
///
/// A contact point does not change during its contact, so the sum over i is done once, at the touch.
class EnergyExpansion {
 public:
  EnergyExpansion() = default;
  /// All coefficients are zero. Throws std::invalid_argument for a degree above 15, no degree in the length, or a root
  /// that is not 1 or 2.
  EnergyExpansion(const EnergyScales& scales, const EnergyDegrees& degrees);

  const EnergyScales& scales() const { return scales_; }
  /// Changes to a unit of length and one of energy, given in the new ones.
  void changeUnits(double length, double energy) {
    scales_.length *= length;
    scales_.energy *= energy;
  }
  int size() const { return static_cast<int>(terms_.size()) * (degrees_.distance + 1); }

  /// Energy (J) and its gradient (N) by the displacement for a unit of each coefficient (3 x size).
  void basis(double angle, const Eigen::Vector3d& displacement, Eigen::VectorXd& energy,
             Eigen::Matrix3Xd& gradient) const;

  /// See energy_fit.h. Throws std::invalid_argument when they are not size() many.
  void setCoefficients(Eigen::VectorXd coefficients);
  const Eigen::VectorXd& coefficients() const { return coefficients_; }

  /// The expansion at one contact point: a fast function of 3 variables. Allocates once.
  class Local {
   public:
    /// J, N, N/m; zero at zero displacement. Does not allocate.
    Jet evaluate(const Eigen::Vector3d& displacement) const;

   private:
    friend class EnergyExpansion;
    EnergyScales scales_;
    int root_ = 2;
    int highest_ = 0;                          ///< power of powers_
    std::vector<std::pair<int, int>> powers_;  ///< of a and w, for each column
    Eigen::MatrixXd coefficients_;             ///< of T_n (row) in each column
  };
  void makeLocal(double angle, Local& local) const;

  /// Multiplies the force along every straight path by a function of s: that of an expansion of a
  /// force itself, and the derivative by the length of an expansion of an energy. The product is
  /// approximated by a polynomial in s of the same degree, with errors relative to `size`, which the
  /// force along a path has at s in some unit.
  void scaleAlongPaths(const std::function<double(double)>& factor, const std::function<double(double)>& size);

 private:
  struct Term {
    int i, j, k;
    int column;  ///< of Local, for (j, k)
  };
  EnergyScales scales_;
  EnergyDegrees degrees_;
  std::vector<Term> terms_;
  std::vector<std::pair<int, int>> powers_;
  Eigen::VectorXd coefficients_;
};

}  // namespace microinjection
