#pragma once

#include <Eigen/Core>
#include <limits>

namespace microinjection {

/// The tongue under one suction, without dimension: lengths over the cell's radius R, suction and force over the
/// modulus E of its outermost layer (and R^2).
struct DrawnTongue {
  double length = std::numeric_limits<double>::quiet_NaN();  ///< from the plane of the lip's crest
  double volume = std::numeric_limits<double>::quiet_NaN();  ///< behind that plane, in the bore
  double seal_radius = std::numeric_limits<double>::quiet_NaN();
  double clamping_force = std::numeric_limits<double>::quiet_NaN();  ///< of the lip: suction times the seal's area
  double length_slope = std::numeric_limits<double>::quiet_NaN();    ///< d length / d suction
  double volume_slope = std::numeric_limits<double>::quiet_NaN();    ///< d volume / d suction
  double expected_error = std::numeric_limits<double>::quiet_NaN();  ///< relative, of the length; one of ten has more
};

/// Columns of a tongue's curves, at the fractions tongueFractions() of the strongest suction (rows).
struct TongueCurves {
  static constexpr int kNodes = 12;
  static constexpr int kPlaces = 30;  ///< of the surface
  enum Column {
    kLogLength,  ///< log of the length's rise above the touch, over a s, less tongueGrowth()
    kLogEnd,     ///< log of the suction at which the equilibria end, in each row
    kLogVolume,  ///< log of the volume's rise above the touch, over a^3 s, less tongueGrowth()
    kSeal,       ///< its radius over that of the touch
    kEnds,       ///< 1: the equilibria end there; 0: the solution does
    kSurface,    ///< displacements (r, z) of tonguePlaces() over a
    kColumns = kSurface + 2 * kPlaces
  };
};

/// Suctions over the strongest one, ascending, at which a tongue's curves are known: Chebyshev points of the root,
/// because the contact closes as s log s at no suction.
Eigen::VectorXd tongueFractions();

/// Angles (rad) from the lower pole, where the mouth is, of the surface's places at rest: half of them within the
/// touch, dense about it. `touch`: angle at which the mouth touches the cell.
Eigen::VectorXd tonguePlaces(double touch);

/// The strongest suction that is served, over that at which the equilibria end: the tongue's slope is infinite there.
constexpr double kServedSuction = 0.95;

/// What the mouth has at no suction, where a sphere of radius 1 lies in it.
struct TongueTouch {
  TongueTouch(double bore_radius, double edge_radius);
  double bore_radius, radius, length, volume;  ///< of the bore and of the touch; of the cell behind the plane
};

/// A cell's tongue as a function of the suction, made by TongueFamily.
///
///     L(s) = L0 + a s exp(g(sqrt(s)) + growth)     L0: of the touch, exact; g: a polynomial, nearly constant
///
/// L / (a s) would be constant for a half-space (Theret and others 1988); so g holds what the cell's curvature, the lip
/// and the large strain make of it, and is smooth from needle bores of a fiftieth of the cell to half of it. log L over
/// s is not: it spans decades near no suction.
/// at() takes well below a microsecond and allocates nothing; several threads may use it at once.
class FamilyTongue {
 public:
  /// @param growth see tongueGrowth()
  /// @param curves see TongueCurves
  /// @param error of g, to be expected; `end_error`: same, of the end
  FamilyTongue(const TongueTouch& touch, double growth, const Eigen::MatrixXd& curves, double error, double end_error);

  /// Suction over modulus to which the tongue is known: kServedSuction of end().
  double strongest() const { return strongest_; }
  /// Suction over modulus at which the equilibria end: the cell is then drawn in without end. Where equilibriumEnds()
  /// is false, the solved members end before that, and it is the end of what is tabulated.
  double end() const { return end_; }
  bool equilibriumEnds() const { return ends_; }
  double endError() const { return end_error_; }  ///< relative, expected, of end(); one of ten has more
  double boreRadius() const { return touch_.bore_radius; }

  /// @param suction over modulus, from 0 to strongest(); all is not a number elsewhere
  DrawnTongue at(double suction) const;
  /// (r, z) over the cell's radius of the deformed surface, from the pole in the mouth to the other one, in the frame
  /// in which the mouth is where it touched the cell at rest. Allocates. @pre as at()
  Eigen::Matrix2Xd outline(double suction) const;

 private:
  using Basis = Eigen::Matrix<double, TongueCurves::kNodes, 1>;

  void basis(double suction, Basis& value, Basis& slope) const;

  TongueTouch touch_;
  double growth_;
  Eigen::Matrix<double, TongueCurves::kNodes, 3> coefficients_;  ///< of length, volume and seal
  Eigen::MatrixXd surface_;                                      ///< coefficients
  double error_, end_error_, end_, strongest_;
  bool ends_;
};

}  // namespace microinjection
