#pragma once

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>

namespace microinjection {

/// Sparse Cholesky factorisation L L^T of a symmetric positive definite matrix given by its lower triangle. The one
/// place that chooses the library: CHOLMOD's simplicial factorisation after nested dissection. It calls no BLAS, so the
/// bits do not depend on which BLAS a machine has, and on the meshes of a live session it is the fastest of those that
/// `./dev bench solver` compares.
class SparseCholesky {
 public:
  SparseCholesky() {
    cholmod_common& settings = solver_.cholmod();
    settings.print = 0;  // a matrix that is not positive definite is an answer, not a warning
    settings.nmethods = 1;
    settings.method[0].ordering = CHOLMOD_NESDIS;
  }

  /// Symbolic analysis; the pattern must not change afterwards.
  void analyse(const Eigen::SparseMatrix<double>& lower) { solver_.analyzePattern(lower); }

  /// False when the matrix is not positive definite.
  bool factorise(const Eigen::SparseMatrix<double>& lower) {
    solver_.factorize(lower);
    return solver_.info() == Eigen::Success;
  }

  /// @pre factorise() returned true.
  template <typename Right>
  typename Right::PlainObject solve(const Eigen::MatrixBase<Right>& right_hand_side) const {
    return solver_.solve(right_hand_side);
  }

 private:
  Eigen::CholmodSimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver_;
};

}  // namespace microinjection
