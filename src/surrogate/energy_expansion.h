#pragma once

#include <Eigen/Core>
#include <vector>

#include "surrogate/jet.h"

namespace microinjection {

/// What a unit of the expansion's variables is.
struct EnergyScales {
  double angle = 1.0471975511965976;  ///< rad, of the place of contact from the pole
  double lateral = 5e-6;              ///< m, of the tip's displacement
  double depth = 20e-6;               ///< m, of the tip's displacement
  double energy = 1e-12;              ///< J
};

struct EnergyDegrees {
  int place = 8;       ///< in the contact angle, even
  int direction = 10;  ///< in the displacement's direction, even
  int distance = 7;    ///< in the square root of its length
};

/// Stored energy of a cell of revolution as a function of where the tip touched it and of how it moved since.
///
/// The tip's displacement u is in the frame of the place: x away from the axis of the cell, z along the needle, out of
/// the cell. With v = (u_x / lateral, u_y / lateral, -u_z / depth), t = |v|, a = v_x / (t + v_z), r = (t - v_z) / (t +
/// v_z) (a and r are the stereographic picture's x and squared length), s = sqrt(t) and c = angle / scale:
///
///     E = energy t^2 sum_(i, j, k, n) C_ijkn (c^2)^i (c a)^j r^k T_n(2 s / s_max - 1)
///
/// These are all smooth functions of two plane vectors, the place and the lateral displacement, that do not change when
/// both are turned or mirrored together; t^2 and powers of s hold both a patch that sticks (E ~ t^2 at first) and a
/// round tip (t^(5/2), Hertz).
class EnergyExpansion {
 public:
  EnergyExpansion() = default;
  EnergyExpansion(const EnergyScales& scales, const EnergyDegrees& degrees);

  const EnergyScales& scales() const { return scales_; }
  const EnergyDegrees& degrees() const { return degrees_; }
  int size() const { return static_cast<int>(terms_.size()) * (degrees_.distance + 1); }

  /// Of each coefficient: energy (J) and its gradient (N) by the displacement, per unit. (3 x size)
  void basis(double angle, const Eigen::Vector3d& displacement, Eigen::VectorXd& energy,
             Eigen::Matrix3Xd& gradient) const;

  /// The coefficients that fit `gradient` best; see basis().
  void setCoefficients(Eigen::VectorXd coefficients);
  const Eigen::VectorXd& coefficients() const { return coefficients_; }

  /// The expansion at one place: of 3 variables only, and quick. Allocates once.
  class Local {
   public:
    /// J, N, N/m; zero at no displacement. Allocates nothing.
    Jet evaluate(const Eigen::Vector3d& displacement) const;

   private:
    friend class EnergyExpansion;
    EnergyScales scales_;
    std::vector<std::pair<int, int>> powers_;  ///< of a and r, for each column
    Eigen::MatrixXd coefficients_;             ///< of T_n (row) in each column
  };
  void makeLocal(double angle, Local& local) const;

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
