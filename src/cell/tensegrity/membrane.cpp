#include "cell/tensegrity/membrane.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "cell/material/volume.h"

namespace microinjection {
namespace {

using Matrix32d = Eigen::Matrix<double, 3, 2>;

/// h C of plane stress, N/m, for (E11, E22, 2 E12).
Eigen::Matrix3d planeStress(const MembraneConfig& config) {
  const double nu = config.poisson_ratio;
  Eigen::Matrix3d C;
  C << 1, nu, 0, nu, 1, 0, 0, 0, (1 - nu) / 2;
  return config.thickness * config.young_modulus / (1 - nu * nu) * C;
}

}  // namespace

Membrane::Membrane(std::shared_ptr<const NodePositions> node_positions, const Geometry& geometry,
                   const MembraneConfig& config, const Eigen::VectorXd& start)
    : node_positions_(std::move(node_positions)),
      stiffness_(planeStress(config)),
      tension_(config.tension),
      pressure_(2 * config.tension / geometry.radius),
      retardation_time_(config.retardation_time) {
  for (const std::array<int, 3>& triangle : geometry.triangles) {
    Facet facet;
    for (int a = 0; a < 3; ++a) {
      facet.nodes[a] = geometry.nodes[triangle[a]];
      for (int k = 0; k < 3; ++k) facet.entries.push_back(3 * facet.nodes[a] + k);
    }
    const Eigen::Vector3d& origin = geometry.rest[triangle[0]];
    const Eigen::Vector3d first = geometry.rest[triangle[1]] - origin, second = geometry.rest[triangle[2]] - origin;
    const Eigen::Vector3d u = first.normalized(), v = first.cross(second).stableNormalized().cross(u);
    Eigen::Matrix2d edges;
    edges << first.dot(u), second.dot(u), first.dot(v), second.dot(v);
    facet.area = 0.5 * edges.determinant();
    const Eigen::Matrix2d inverse = edges.inverse();
    facet.gradients << -inverse.colwise().sum(), inverse;
    facet.start = strain(positions(facet, start) * facet.gradients);
    facet.before = facet.accepted = facet.start;
    facets_.push_back(std::move(facet));
  }
}

Eigen::Matrix3d Membrane::positions(const Facet& facet, const Eigen::VectorXd& state) const {
  Eigen::Matrix3d x;
  for (int a = 0; a < 3; ++a) x.col(a) = (*node_positions_)[facet.nodes[a]] + state.segment<3>(3 * facet.nodes[a]);
  return x;
}

Eigen::Vector3d Membrane::strain(const Matrix32d& F) {
  return {0.5 * (F.col(0).squaredNorm() - 1), 0.5 * (F.col(1).squaredNorm() - 1), F.col(0).dot(F.col(1))};
}

bool Membrane::evaluate(int index, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  const Facet& facet = facets_[index];
  const Eigen::Matrix3d x = positions(facet, state);
  const Matrix32d F = x * facet.gradients;
  const Eigen::Vector3d E = strain(F), rate = E - facet.before;
  const Eigen::Vector3d elastic = stiffness_ * E, viscous = viscous_ * (stiffness_ * rate);
  const Eigen::Vector3d x1 = x.col(0), x2 = x.col(1), x3 = x.col(2);
  result.zero = false;
  result.energy = facet.area * (0.5 * E.dot(elastic) + tension_ * (E[0] + E[1]) + 0.5 * rate.dot(viscous)) -
                  pressure_ / 6 * x1.dot(x2.cross(x3));
  if (order == Order::kEnergy) return true;
  const Eigen::Vector3d stress = elastic + viscous + Eigen::Vector3d(tension_, tension_, 0);  // N/m
  Eigen::Matrix<double, 3, 9> B;                                                              // strain derivative
  for (int a = 0; a < 3; ++a) {
    const double g1 = facet.gradients(a, 0), g2 = facet.gradients(a, 1);
    B.middleCols<3>(3 * a) << g1 * F.col(0).transpose(), g2 * F.col(1).transpose(),
        (g2 * F.col(0) + g1 * F.col(1)).transpose();
  }
  result.gradient = facet.area * (B.transpose() * stress);
  Eigen::Matrix<double, 9, 1> volume;
  volume << x2.cross(x3), x3.cross(x1), x1.cross(x2);
  result.gradient -= pressure_ / 6 * volume;
  if (order == Order::kGradient) return true;
  result.hessian = facet.area * (1 + viscous_) * (B.transpose() * stiffness_ * B);
  Eigen::Matrix2d S;
  S << stress[0], stress[2], stress[2], stress[1];
  const Eigen::Matrix3d geometric = facet.area * (facet.gradients * S * facet.gradients.transpose());
  const double sixth = pressure_ / 6;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      auto block = result.hessian.block<3, 3>(3 * a, 3 * b);
      block.diagonal().array() += geometric(a, b);
      if (a == b) continue;
      const Eigen::Matrix3d turn = sixth * cross(x.col(3 - a - b));  // of the third corner
      if ((a + 1) % 3 == b)
        block += turn;
      else
        block -= turn;
    }
  }
  return true;
}

bool Membrane::beginStep(double duration) {
  viscous_ = std::isfinite(duration) ? retardation_time_ / duration : 0;
  for (Facet& facet : facets_) facet.before = facet.accepted;
  return viscous_ > 0;
}

void Membrane::accept(const Eigen::VectorXd& state) {
  for (Facet& facet : facets_) facet.accepted = strain(positions(facet, state) * facet.gradients);
}

void Membrane::reset() {
  for (Facet& facet : facets_) facet.before = facet.accepted = facet.start;
  viscous_ = 0;
}

}  // namespace microinjection
