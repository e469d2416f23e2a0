#include "cell/mechanics/symmetric_solver.h"

#include <dlfcn.h>
#include <omp.h>

#include <algorithm>
#include <mutex>
#include <stdexcept>

namespace microinjection {
namespace {

/// CHOLMOD's view of a lower triangle, for reading only.
cholmod_sparse view(const Eigen::SparseMatrix<double>& lower) {
  cholmod_sparse matrix{};
  matrix.nrow = lower.rows();
  matrix.ncol = lower.cols();
  matrix.nzmax = lower.nonZeros();
  matrix.p = const_cast<int*>(lower.outerIndexPtr());
  matrix.i = const_cast<int*>(lower.innerIndexPtr());
  matrix.x = const_cast<double*>(lower.valuePtr());
  matrix.stype = -1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_REAL;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = 1;
  matrix.packed = 1;
  return matrix;
}

/// During its lifetime OpenMP regions of this thread have one thread. CHOLMOD requests four threads
/// for loops so short that waking them takes longer than the factorisation.
class WithoutOpenMp {
 public:
  WithoutOpenMp() : before_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~WithoutOpenMp() { omp_set_max_active_levels(before_); }
  WithoutOpenMp(const WithoutOpenMp&) = delete;
  WithoutOpenMp& operator=(const WithoutOpenMp&) = delete;

 private:
  int before_;
};

}  // namespace

void SymmetricSolver::useOneThread() {
  // Looked up at run time, because the system chooses the BLAS when the program is loaded.
  const auto set = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"));
  if (set != nullptr) set(1);
}

SymmetricSolver::SymmetricSolver(Method method) : method_(method) {
  cholmod_start(&common_);
  common_.print = 0;  // a matrix that is not positive definite is a result, not a warning
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_NESDIS;
  common_.supernodal = method == Method::kSupernodal ? CHOLMOD_SUPERNODAL : CHOLMOD_SIMPLICIAL;
  common_.final_ll = method == Method::kIndefinite ? 0 : 1;
  common_.quick_return_if_not_posdef = 1;
}

SymmetricSolver::~SymmetricSolver() {
  cholmod_free_factor(&factor_, &common_);
  cholmod_finish(&common_);
}

void SymmetricSolver::analyse(const Eigen::SparseMatrix<double>& lower, const std::vector<int>& last) {
  cholmod_free_factor(&factor_, &common_);
  cholmod_sparse matrix = view(lower);
  // METIS seeds and uses the process's only random sequence. One thread at a time gets the same
  // order in every run.
  static std::mutex metis;
  const std::lock_guard<std::mutex> lock(metis);
  factor_ = cholmod_analyze(&matrix, &common_);
  if (factor_ != nullptr && method_ == Method::kSupernodal && !last.empty()) {
    std::vector<char> is_last(factor_->n, 0);
    for (const int unknown : last) is_last[unknown] = 1;
    const int* best = static_cast<const int*>(factor_->Perm);
    std::vector<int> order(best, best + factor_->n);
    std::stable_partition(order.begin(), order.end(), [&](int unknown) { return !is_last[unknown]; });
    cholmod_free_factor(&factor_, &common_);
    common_.method[0].ordering = CHOLMOD_GIVEN;
    factor_ = cholmod_analyze_p(&matrix, order.data(), nullptr, 0, &common_);
    common_.method[0].ordering = CHOLMOD_NESDIS;
  }
  if (factor_ == nullptr) throw std::runtime_error("CHOLMOD's analysis of the equations failed");
  findLast(last);
}

void SymmetricSolver::findLast(const std::vector<int>& last) {
  last_.clear();
  if (method_ != Method::kSupernodal) return;
  std::vector<int> index(factor_->n, -1);
  for (std::size_t i = 0; i < last.size(); ++i) index[last[i]] = static_cast<int>(i);
  const int* order = static_cast<const int*>(factor_->Perm);
  for (std::size_t pivot = factor_->n - last.size(); pivot < factor_->n; ++pivot) {
    last_.push_back(index[order[pivot]]);
  }
  // CHOLMOD sorts pivots by their tree. It puts these last only where the others connect them all.
  if (std::find(last_.begin(), last_.end(), -1) != last_.end()) last_.clear();
}

bool SymmetricSolver::factorise(const Eigen::SparseMatrix<double>& lower, int negative) {
  const WithoutOpenMp one_thread;
  cholmod_sparse matrix = view(lower);
  updated_ = false;
  last_factor_.resize(0, 0);
  cholmod_factorize(&matrix, factor_, &common_);
  if (common_.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (factor_->minor != factor_->n) return false;
  return method_ != Method::kIndefinite || inertiaIs(negative);
}

bool SymmetricSolver::inertiaIs(int negative) const {
  const int* columns = static_cast<const int*>(factor_->p);
  const double* values = static_cast<const double*>(factor_->x);
  int found = 0;
  for (std::size_t j = 0; j < factor_->n; ++j) found += values[columns[j]] < 0;  // D is the first entry of each column
  return found == negative;
}

/// The lower triangle of L that belongs to the last pivots, from the supernodes that have them.
Eigen::MatrixXd SymmetricSolver::lastBlock() const {
  const auto size = static_cast<int>(last_.size()), first = static_cast<int>(factor_->n) - size;
  const int *super = static_cast<const int*>(factor_->super), *starts = static_cast<const int*>(factor_->pi),
            *values_at = static_cast<const int*>(factor_->px), *rows = static_cast<const int*>(factor_->s);
  const double* values = static_cast<const double*>(factor_->x);
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t s = 0; s < factor_->nsuper; ++s) {
    const int height = starts[s + 1] - starts[s];
    for (int column = std::max(super[s], first); column < super[s + 1]; ++column) {
      const double* below = values + values_at[s] + static_cast<std::ptrdiff_t>(column - super[s]) * height;
      for (int k = column - super[s]; k < height; ++k) block(rows[starts[s] + k] - first, column - first) = below[k];
    }
  }
  return block;
}

bool SymmetricSolver::update(const Eigen::MatrixXd& change) {
  if (last_.empty()) return false;
  if (last_factor_.size() == 0) last_factor_ = lastBlock();
  const auto factor = last_factor_.triangularView<Eigen::Lower>();
  Eigen::MatrixXd schur = factor * last_factor_.transpose();
  for (Eigen::Index column = 0; column < schur.cols(); ++column) {
    for (Eigen::Index row = column; row < schur.rows(); ++row) schur(row, column) += change(last_[row], last_[column]);
  }
  schur_.compute(schur);
  updated_ = schur_.info() == Eigen::Success;
  return updated_;
}

Eigen::MatrixXd SymmetricSolver::solve(const Eigen::MatrixXd& right_hand_side) {
  if (!updated_) return apply(CHOLMOD_A, right_hand_side);
  // L y = P b. The last part of y is that of the old Schur complement; the new one takes its place.
  Eigen::MatrixXd y = apply(CHOLMOD_L, apply(CHOLMOD_P, right_hand_side));
  const auto factor = last_factor_.triangularView<Eigen::Lower>();
  const Eigen::MatrixXd right = factor * y.bottomRows(last_factor_.rows());
  y.bottomRows(last_factor_.rows()) = last_factor_.transpose().triangularView<Eigen::Upper>() * schur_.solve(right);
  return apply(CHOLMOD_Pt, apply(CHOLMOD_Lt, y));
}

/// Solves one of the systems of cholmod_solve.
Eigen::MatrixXd SymmetricSolver::apply(int system, const Eigen::MatrixXd& right_hand_side) {
  const WithoutOpenMp one_thread;
  cholmod_dense right{};
  right.nrow = right_hand_side.rows();
  right.ncol = right_hand_side.cols();
  right.nzmax = right_hand_side.size();
  right.d = right.nrow;
  right.x = const_cast<double*>(right_hand_side.data());
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(system, factor_, &right, &common_);
  if (solution == nullptr) throw std::runtime_error("CHOLMOD could not solve the equations");
  Eigen::MatrixXd result =
      Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution->x), right.nrow, right.ncol);
  cholmod_free_dense(&solution, &common_);
  return result;
}

}  // namespace microinjection
