#pragma once

#include <cholmod.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace microinjection {

/// Sparse direct factorisation of a symmetric matrix given by its lower triangle, with CHOLMOD (SuiteSparse) after
/// nested dissection.
class SymmetricSolver {
 public:
  enum class Method {
    kSimplicial,  ///< L L^T without BLAS: the same bits on every machine, fastest for small systems (live sessions)
    kSupernodal,  ///< L L^T with BLAS: fastest for large systems
    kIndefinite   ///< L D L^T: mixed elements, whose pressures make as many negative pivots
  };

  explicit SymmetricSolver(Method method);

  /// From now on BLAS uses one thread in all of this process, if it is OpenBLAS: the same bits in every run, and the
  /// other processors left to other threads.
  static void useOneThread();

  ~SymmetricSolver();
  SymmetricSolver(const SymmetricSolver&) = delete;
  SymmetricSolver& operator=(const SymmetricSolver&) = delete;

  /// Symbolic analysis; the pattern must not change afterwards.
  void analyse(const Eigen::SparseMatrix<double>& lower);

  /// False when the matrix has another number of negative eigenvalues than `negative` (0 but for kIndefinite), or is
  /// singular.
  bool factorise(const Eigen::SparseMatrix<double>& lower, int negative = 0);

  /// @pre factorise() returned true. A vector or the columns of a matrix.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_side);

  double factorEntries() const { return common_.lnz; }  ///< nonzeros of L

 private:
  bool inertiaIs(int negative) const;

  Method method_;
  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace microinjection
