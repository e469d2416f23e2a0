#include "cell/family/family_tongue.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "cell/contact/pipette_mouth.h"

namespace microinjection {
namespace {

constexpr int kNodes = TongueCurves::kNodes;
constexpr double kLowestRoot = 0.06;   ///< of the strongest suction, at which a curve begins; a polynomial from there
constexpr double kMeshOfRise = 0.003;  ///< relative, of the rise: of the members' meshes
constexpr double kContactOfLength = 0.002;  ///< relative, of the length: of the lip's stiffness

/// Coordinate of the polynomials, -1 at the lowest root and 1 at the strongest suction.
double toUnit(double root) { return (2 * root - 1 - kLowestRoot) / (1 - kLowestRoot); }

/// Chebyshev polynomials and their slopes.
template <typename Vector>
void chebyshev(double x, Vector& value, Vector& slope) {
  value[0] = 1;
  slope[0] = 0;
  double second = 0, before = 1;  // of the second kind: U_{n-2}, U_{n-1}
  for (int n = 1; n < kNodes; ++n) {
    value[n] = n == 1 ? x : 2 * x * value[n - 1] - value[n - 2];
    slope[n] = n * before;
    const double next = 2 * x * before - second;
    second = before;
    before = next;
  }
}

/// Coefficients of the polynomials through values at tongueFractions().
Eigen::MatrixXd coefficientsOf(const Eigen::MatrixXd& values) {
  static const Eigen::MatrixXd inverse = [] {
    const Eigen::VectorXd fractions = tongueFractions();
    Eigen::MatrixXd rows(kNodes, kNodes);
    Eigen::VectorXd value(kNodes), slope(kNodes);
    for (int i = 0; i < kNodes; ++i) {
      chebyshev(toUnit(std::sqrt(fractions[i])), value, slope);
      rows.row(i) = value.transpose();
    }
    return Eigen::MatrixXd(rows.inverse());
  }();
  return inverse * values;
}

}  // namespace

Eigen::VectorXd tongueFractions() {
  Eigen::VectorXd result(kNodes);
  for (int i = 0; i < kNodes; ++i) {
    const double x = -std::cos(M_PI * i / (kNodes - 1));
    result[i] = std::pow(((1 - kLowestRoot) * x + 1 + kLowestRoot) / 2, 2);
  }
  return result;
}

Eigen::VectorXd tonguePlaces(double touch) {
  constexpr int kWithin = TongueCurves::kPlaces / 2, kBeyond = TongueCurves::kPlaces - kWithin;
  Eigen::VectorXd angles(TongueCurves::kPlaces);
  for (int i = 0; i < kWithin; ++i) angles[i] = touch * std::sin(0.5 * M_PI * i / kWithin);
  for (int i = 0; i < kBeyond; ++i) {
    const double share = static_cast<double>(i) / (kBeyond - 1);
    angles[kWithin + i] = i + 1 < kBeyond ? touch * std::pow(M_PI / touch, share * std::sqrt(share)) : M_PI;
  }
  return angles;
}

TongueTouch::TongueTouch(double bore, double edge_radius) : bore_radius(bore) {
  const PipetteMouth mouth(bore, bore + 2 * edge_radius, edge_radius, -1);
  radius = mouth.touchRadius(1);
  const double plane = mouth.touchDistance(1);
  length = 1 - plane;
  volume = 2 * M_PI / 3 * (1 - std::pow(1 - radius * radius, 1.5)) - M_PI * radius * radius * plane;
}

FamilyTongue::FamilyTongue(const TongueTouch& touch, double growth, const Eigen::MatrixXd& curves, double error,
                           double end_error)
    : touch_(touch),
      growth_(growth),
      surface_(coefficientsOf(curves.rightCols(2 * TongueCurves::kPlaces))),
      error_(std::hypot(error, kMeshOfRise)),
      end_error_(end_error),
      end_(std::exp(curves(0, TongueCurves::kLogEnd))),
      strongest_(kServedSuction * end_),
      ends_(curves(0, TongueCurves::kEnds) > 0.5) {
  int column = 0;
  for (const int of : {TongueCurves::kLogLength, TongueCurves::kLogVolume, TongueCurves::kSeal})
    coefficients_.col(column++) = coefficientsOf(curves.col(of));
}

void FamilyTongue::basis(double suction, Basis& value, Basis& slope) const {
  chebyshev(toUnit(std::sqrt(suction / strongest_)), value, slope);
}

DrawnTongue FamilyTongue::at(double suction) const {
  DrawnTongue result;
  if (!(suction >= 0 && suction <= strongest_)) return result;
  Basis value, slope;
  basis(suction, value, slope);
  const Eigen::Matrix<double, 1, 3> at = value.transpose() * coefficients_, rise = slope.transpose() * coefficients_;
  const double by_suction = std::sqrt(suction / strongest_) / (1 - kLowestRoot);  // suction d(coordinate)/d(suction)
  const double a = touch_.bore_radius, length = a * std::exp(at[0] + growth_),
               volume = a * a * a * std::exp(at[1] + growth_);
  result.length = touch_.length + length * suction;
  result.length_slope = length * (1 + by_suction * rise[0]);
  result.volume = touch_.volume + volume * suction;
  result.volume_slope = volume * (1 + by_suction * rise[1]);
  result.seal_radius = touch_.radius * at[2];
  result.clamping_force = suction * M_PI * result.seal_radius * result.seal_radius;
  result.expected_error = std::hypot(error_ * length * suction / result.length, kContactOfLength);
  return result;
}

Eigen::Matrix2Xd FamilyTongue::outline(double suction) const {
  Basis value, slope;
  basis(suction, value, slope);
  const Eigen::VectorXd moved = touch_.bore_radius * (surface_.transpose() * value);
  const Eigen::VectorXd angles = tonguePlaces(std::asin(touch_.radius));
  Eigen::Matrix2Xd result(2, angles.size());
  for (Eigen::Index i = 0; i < angles.size(); ++i)
    result.col(i) = Eigen::Vector2d(std::sin(angles[i]), -std::cos(angles[i])) + moved.segment<2>(2 * i);
  return result;
}

}  // namespace microinjection
