#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <string>

#include "cell/mechanics/equilibrium_system.h"

namespace microinjection {

struct RelaxationConfig {
  double length = 56e-6;          ///< m, size of the body
  int maximum_iterations = 1000;  ///< factorisations
};

/// Brings a system to rest from any state, inverted elements included, by minimising its energy:
/// Newton's method with the tangent shifted until it is positive definite (Levenberg 1944; K + s D,
/// with D the diagonal of the undeformed K), and a line search on the energy (Armijo 1966). It ends
/// in a stable state of rest; if there are several, the start decides which. One thread at a time.
///
/// For inverted elements the body must be of Inversion::kAllowed and its materials must not resist
/// inversion.
class Relaxation {
 public:
  struct Result {
    bool converged = false;
    std::string reason;  ///< empty when converged
    int iterations = 0;  ///< factorisations
    double energy = 0;   ///< J, of the final state
  };

  /// `system` must outlive this. Throws std::invalid_argument when its undeformed state is not
  /// admissible, or when it has pressures other than internal ones, because the energy at
  /// equilibrium is not minimal in them.
  Relaxation(EquilibriumSystem& system, const RelaxationConfig& config);

  /// Moves the free entries of `state` to rest; the others do not change. On failure `state` is the
  /// state of lowest energy found.
  Result relax(Eigen::VectorXd& state);

 private:
  bool evaluate(Eigen::VectorXd& state, double& energy);
  bool differentiate(const Eigen::VectorXd& state, Eigen::VectorXd& gradient);
  bool factorise(Result& result);
  bool isStationary() const;
  Eigen::VectorXd softestDirection();
  double descend(Eigen::VectorXd& state, const Eigen::VectorXd& direction);
  bool isLower(Eigen::VectorXd& candidate, double promise, double& energy);

  EquilibriumSystem& system_;
  RelaxationConfig config_;
  SymmetricSolver solver_;
  Eigen::SparseMatrix<double> shifted_;
  Eigen::VectorXd diagonal_;  ///< D, N/m
  double rounding_ = 0;       ///< J, rounding error of the energy
  double shift_ = 0;          ///< s
  double energy_ = 0;         ///< J, of the present state, as gradient_
  Eigen::VectorXd gradient_, candidate_gradient_;
};

}  // namespace microinjection
