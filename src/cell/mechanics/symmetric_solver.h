#pragma once

#include <cholmod.h>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace microinjection {

/// Sparse direct factorisation of a symmetric matrix, given by its lower triangle, with CHOLMOD
/// (SuiteSparse) and nested dissection.
class SymmetricSolver {
 public:
  enum class Method {
    kSimplicial,  ///< L L^T without BLAS: identical results on every machine, fastest for small systems (live sessions)
    kSupernodal,  ///< L L^T with BLAS: fastest for large systems
    kIndefinite   ///< L D L^T: mixed elements, with one negative pivot for each pressure
  };

  explicit SymmetricSolver(Method method);

  /// Limits BLAS to one thread in the whole process, if it is OpenBLAS. Results are then the same
  /// in every run, and the other processors stay free for other threads.
  static void useOneThread();

  ~SymmetricSolver();
  SymmetricSolver(const SymmetricSolver&) = delete;
  SymmetricSolver& operator=(const SymmetricSolver&) = delete;

  /// Symbolic analysis; the pattern must not change afterwards.
  void analyse(const Eigen::SparseMatrix<double>& lower);

  /// False when the matrix is singular or the number of its negative eigenvalues is not `negative`
  /// (0 except for kIndefinite).
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
