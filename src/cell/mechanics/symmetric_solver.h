#pragma once

#include <cholmod.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

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

  /// Symbolic analysis; the pattern must not change afterwards. `last`: unknowns that are eliminated
  /// last, so that update() may change their block; kSupernodal only, ignored by the others.
  void analyse(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& last = {});

  /// False when the matrix is singular or the number of its negative eigenvalues is not `negative`
  /// (0 except for kIndefinite).
  bool factorise(const Eigen::SparseMatrix<double>& lower, int negative = 0);

  /// Adds `change`, symmetric, to the factorised matrix's block of the last unknowns, in their
  /// order; a later change replaces it. Costs a dense factorisation of this block, their Schur
  /// complement. False when the matrix is then not positive definite, or cannot be changed; solve()
  /// must not be called before the next factorise() then. @pre factorise() returned true.
  bool update(const Eigen::MatrixXd& change);

  /// @pre factorise() or update() returned true. A vector or the columns of a matrix.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& right_hand_side);

  double factorEntries() const { return common_.lnz; }  ///< nonzeros of L

 private:
  bool inertiaIs(int negative) const;
  void findLast(const std::vector<int>& last);
  Eigen::MatrixXd lastBlock() const;
  Eigen::MatrixXd apply(int system, const Eigen::MatrixXd& right_hand_side);

  Method method_;
  cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  std::vector<int> last_;              ///< index among `last` of each of the last pivots; empty: none may change
  Eigen::MatrixXd last_factor_;        ///< block of L of the last pivots; empty until update() needs it
  Eigen::LLT<Eigen::MatrixXd> schur_;  ///< of the changed Schur complement
  bool updated_ = false;
};

}  // namespace microinjection
