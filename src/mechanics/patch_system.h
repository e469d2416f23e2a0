#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "mechanics/elastic_body.h"
#include "mechanics/sparse_cholesky.h"

namespace microinjection {

/// The equations of an elastic body some of whose vertices are held and some move together as one rigid, translating
/// patch. The unknowns are the displacements of the free vertices (`free`, 3 each) and the patch's translation t (3):
///
///     [ K_ff  K_ft ] [ du ]   [ -r_f ]        r: derivative of the energy, N
///     [ K_tf  K_tt ] [ dt ] = [  dR  ]        R = r_t: the force on the patch that holds it there
///
/// The pattern of K_ff and its symbolic factorisation are made once.
class PatchSystem {
 public:
  /// `body` must outlive this. `patch` may be empty, which leaves plain Dirichlet conditions: held vertices keep the
  /// displacement that they have in `u`. Throws std::invalid_argument when a vertex is in both lists, or none is free.
  PatchSystem(const ElasticBody& body, const std::vector<int>& held, const std::vector<int>& patch);

  const ElasticBody& body() const { return body_; }
  int freeSize() const { return free_size_; }

  /// Full displacement += (free displacement, translation of the patch).
  void addTo(Eigen::VectorXd& u, const Eigen::VectorXd& free, const Eigen::Vector3d& translation) const;

  /// r_f and R at `u`. @pre body().energy(u) is finite.
  void residual(const Eigen::VectorXd& u, Eigen::VectorXd& free, Eigen::Vector3d& reaction);

  /// Assembles the tangent at `u` and factorises K_ff. False when it is not positive definite: then `u` is no stable
  /// state, and solve() and stiffness() must not be called.
  bool factorise(const Eigen::VectorXd& u);

  /// K_ff^-1 right_hand_side, with the last factorisation.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side) const { return cholesky_.solve(right_hand_side); }

  /// -K_ff^-1 K_ft: how the free displacements follow the translation at equilibrium (free size x 3).
  const Eigen::Matrix<double, Eigen::Dynamic, 3>& sensitivity() const { return sensitivity_; }

  /// dR/dt at equilibrium, K_tt - K_tf K_ff^-1 K_ft, N/m; symmetric.
  const Eigen::Matrix3d& stiffness() const { return stiffness_; }

  /// K_ff of the last factorise(), lower triangle.
  const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }

 private:
  void numberUnknowns(const std::vector<int>& held, const std::vector<int>& patch);
  void buildPattern();
  void assemble(const Eigen::VectorXd& u);
  void scatter(int element, const ElasticBody::ElementMatrix& stiffness, const int*& slot);

  const ElasticBody& body_;
  int free_size_ = 0;
  std::vector<int> unknown_;  ///< first unknown of each vertex: below free_size_ free, free_size_ the patch, -1 held
  Eigen::SparseMatrix<double> matrix_;
  std::vector<int> slots_;  ///< where in matrix_'s values each 3 x 3 block's columns of each element go
  SparseCholesky cholesky_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> coupling_;  ///< K_ft
  Eigen::Matrix3d patch_stiffness_ = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, 3> sensitivity_;
  Eigen::Matrix3d stiffness_ = Eigen::Matrix3d::Zero();
  Eigen::VectorXd force_;
};

}  // namespace microinjection
