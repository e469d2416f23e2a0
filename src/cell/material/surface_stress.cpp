#include "cell/material/surface_stress.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace microinjection {
namespace {

/// F as a function of its column f = F N.
class NormalColumn {
 public:
  /// @pre the piece has an area.
  explicit NormalColumn(const SurfacePiece& piece) {
    const Eigen::Vector3d along = piece.rest.col(0).normalized();
    normal_ = piece.rest.col(0).cross(piece.rest.col(1)).normalized();
    Eigen::Matrix<double, 3, 2> basis;  // of the surface at rest
    basis << along, normal_.cross(along);
    const Eigen::Matrix2d edges = basis.transpose() * piece.rest;
    const Eigen::Matrix<double, 3, 2> stretched = piece.deformed * edges.inverse();
    in_surface_ = stretched * basis.transpose();
    cofactor_ = stretched.col(0).cross(stretched.col(1));
  }

  Eigen::Matrix3d F(const Eigen::Vector3d& column) const { return in_surface_ + column * normal_.transpose(); }
  const Eigen::Vector3d& normal() const { return normal_; }
  /// cof(F) N, whatever the column is.
  const Eigen::Vector3d& cofactor() const { return cofactor_; }

 private:
  Eigen::Vector3d normal_;
  Eigen::Matrix3d in_surface_;
  Eigen::Vector3d cofactor_;
};

/// Derivative of P N by the column.
Eigen::Matrix3d normalStiffness(const Material::Matrix9d& tangent, const Eigen::Vector3d& normal) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  for (int J = 0; J < 3; ++J) {
    for (int L = 0; L < 3; ++L) result += normal[J] * normal[L] * tangent.block<3, 3>(3 * J, 3 * L);
  }
  return result;
}

/// A direction in which the energy falls: Newton's, where the material is stable.
Eigen::Vector3d descent(const Eigen::Matrix3d& stiffness, const Eigen::Vector3d& residual) {
  const Eigen::LLT<Eigen::Matrix3d> factors(stiffness);
  if (factors.info() == Eigen::Success) return -factors.solve(residual);
  return -residual / stiffness.norm();
}

bool hasArea(const SurfacePiece::Edges& edges) {
  const double area = edges.col(0).cross(edges.col(1)).norm();
  return std::isfinite(area) && area > 1e-6 * edges.squaredNorm();
}

}  // namespace

std::optional<Eigen::Matrix3d> deformationBehind(const SurfacePiece& piece, const Material& material, double pressure) {
  constexpr int kMostIterations = 40, kMostHalvings = 30;
  constexpr double kSmallestForce = 1e-9;  // of the stiffness
  if (!hasArea(piece.rest) || !hasArea(piece.deformed)) return std::nullopt;
  const NormalColumn unknown(piece);
  const Eigen::Vector3d load = -pressure * (material.isLinear() ? unknown.normal() : unknown.cofactor());
  const auto energy = [&](const Eigen::Vector3d& f) { return material.energyDensity(unknown.F(f)) - load.dot(f); };
  Eigen::Vector3d column = unknown.cofactor() / unknown.cofactor().squaredNorm();  // keeps the volume
  double present = energy(column);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const Material::Kinematics kinematics = material.kinematics(unknown.F(column));
    const Eigen::Matrix3d stiffness = normalStiffness(material.tangent(kinematics, material.whole()), unknown.normal());
    const Eigen::Vector3d residual = material.stress(kinematics, material.whole()) * unknown.normal() - load;
    if (!residual.allFinite()) return std::nullopt;
    if (residual.norm() <= kSmallestForce * stiffness.norm()) return unknown.F(column);
    const Eigen::Vector3d step = descent(stiffness, residual);
    double share = 1;
    // Where the energy no longer resolves the step, rounding decides, and Newton's step is taken whole.
    const double noise = 1e-14 * stiffness.norm();
    for (int halving = 0; halving < kMostHalvings && !(energy(column + share * step) <= present + noise); ++halving) {
      share /= 2;
    }
    column += share * step;
    present = energy(column);
    if (!std::isfinite(present)) return std::nullopt;
  }
  return std::nullopt;
}

Eigen::Matrix3d cauchyStress(const Material& material, const Eigen::Matrix3d& F) {
  const Eigen::Matrix3d P = material.stress(F);
  if (material.isLinear()) return P;
  return P * F.transpose() / F.determinant();
}

double vonMisesStress(const Eigen::Matrix3d& cauchy) {
  const Eigen::Matrix3d deviator = cauchy - cauchy.trace() / 3 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

double pressureOf(const Eigen::Matrix3d& cauchy) { return -cauchy.trace() / 3; }

}  // namespace microinjection
