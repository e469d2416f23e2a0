#include "cell/mechanics/symmetric_solver.h"

#include <dlfcn.h>
#include <omp.h>

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

void SymmetricSolver::analyse(const Eigen::SparseMatrix<double>& lower) {
  cholmod_free_factor(&factor_, &common_);
  cholmod_sparse matrix = view(lower);
  // METIS seeds and uses the process's only random sequence. One thread at a time gets the same
  // order in every run.
  static std::mutex metis;
  const std::lock_guard<std::mutex> lock(metis);
  factor_ = cholmod_analyze(&matrix, &common_);
  if (factor_ == nullptr) throw std::runtime_error("CHOLMOD's analysis of the equations failed");
}

bool SymmetricSolver::factorise(const Eigen::SparseMatrix<double>& lower, int negative) {
  const WithoutOpenMp one_thread;
  cholmod_sparse matrix = view(lower);
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

Eigen::MatrixXd SymmetricSolver::solve(const Eigen::MatrixXd& right_hand_side) {
  const WithoutOpenMp one_thread;
  cholmod_dense right{};
  right.nrow = right_hand_side.rows();
  right.ncol = right_hand_side.cols();
  right.nzmax = right_hand_side.size();
  right.d = right.nrow;
  right.x = const_cast<double*>(right_hand_side.data());
  right.xtype = CHOLMOD_REAL;
  right.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* solution = cholmod_solve(CHOLMOD_A, factor_, &right, &common_);
  if (solution == nullptr) throw std::runtime_error("CHOLMOD could not solve the equations");
  Eigen::MatrixXd result =
      Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(solution->x), right.nrow, right.ncol);
  cholmod_free_dense(&solution, &common_);
  return result;
}

}  // namespace microinjection
