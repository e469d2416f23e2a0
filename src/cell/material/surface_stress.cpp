#include "cell/material/surface_stress.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace microinjection {
namespace {

using Triangle = std::array<int, 3>;

SurfacePiece::Edges edgesOf(const std::vector<Eigen::Vector3d>& vertices, const Triangle& triangle) {
  SurfacePiece::Edges edges;
  edges << vertices[triangle[1]] - vertices[triangle[0]], vertices[triangle[2]] - vertices[triangle[0]];
  return edges;
}

double areaOf(const SurfacePiece::Edges& edges) { return edges.col(0).cross(edges.col(1)).norm() / 2; }

int count(const std::vector<bool>& marked, const Triangle& triangle) {
  int result = 0;
  for (const int vertex : triangle) result += marked[vertex] ? 1 : 0;
  return result;
}

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

double meanContactPressure(const LoadedSurface& surface, const Eigen::Vector3d& force) {
  double area = 0;
  Eigen::Vector3d outwards = Eigen::Vector3d::Zero();
  for (const Triangle& triangle : surface.triangles) {
    const int touched = count(surface.touched, triangle);
    if (touched == 0) continue;
    const SurfacePiece::Edges edges = edgesOf(surface.deformed, triangle);
    area += touched / 3.0 * areaOf(edges);
    outwards += touched * edges.col(0).cross(edges.col(1));
  }
  return area > 0 ? std::max(0.0, force.dot(outwards.stableNormalized()) / area) : 0;
}

SurfaceStressField surfaceStress(const LoadedSurface& surface, const Material& material, double pressure) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const std::size_t size = surface.rest.size();
  std::vector<double> weights(size, 0);
  SurfaceStressField field;
  field.von_mises.assign(size, 0);
  field.pressure.assign(size, 0);
  field.normal_column.assign(size, Eigen::Vector3d::Zero());
  for (const Triangle& triangle : surface.triangles) {
    if (count(surface.held, triangle) == 3) continue;
    const SurfacePiece piece{edgesOf(surface.rest, triangle), edgesOf(surface.deformed, triangle)};
    const auto F = deformationBehind(piece, material, count(surface.touched, triangle) / 3.0 * pressure);
    if (!F) continue;
    const Eigen::Matrix3d stress = cauchyStress(material, *F);
    const Eigen::Vector3d column = *F * piece.rest.col(0).cross(piece.rest.col(1)).normalized();
    const double weight = areaOf(piece.rest);
    for (const int vertex : triangle) {
      weights[vertex] += weight;
      field.von_mises[vertex] += weight * vonMisesStress(stress);
      field.pressure[vertex] += weight * pressureOf(stress);
      field.normal_column[vertex] += weight * column;
    }
  }
  for (std::size_t i = 0; i < size; ++i) {
    const double share = weights[i] > 0 ? 1 / weights[i] : kUnknown;
    field.von_mises[i] *= share;
    field.pressure[i] *= share;
    field.normal_column[i] *= share;
  }
  return field;
}

std::optional<Eigen::Matrix3d> deformationBehind(const SurfacePiece& piece, const Material& material, double pressure) {
  constexpr int kMostIterations = 40, kMostHalvings = 30;
  constexpr double kSmallestForce = 1e-9;  // of the stiffness
  if (!hasArea(piece.rest) || !hasArea(piece.deformed)) return std::nullopt;
  const NormalColumn unknown(piece);
  const Eigen::Vector3d load = -pressure * (material.isLinear() ? unknown.normal() : unknown.cofactor());
  const auto energy = [&](const Eigen::Vector3d& f) { return material.energyDensity(unknown.F(f)) - load.dot(f); };
  Eigen::Vector3d column = unknown.cofactor() / unknown.cofactor().squaredNorm();  // keeps the volume
  double present = energy(column);
  // A material with a limit of its stretch may bear a shorter column only.
  for (int halving = 0; halving < kMostHalvings && !std::isfinite(present); ++halving) {
    column /= 2;
    present = energy(column);
  }
  if (!std::isfinite(present)) return std::nullopt;
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
