#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "cell/mechanics/energy_term.h"
#include "cell/mechanics/nonsmooth_tangent.h"
#include "cell/mechanics/symmetric_solver.h"

namespace microinjection {

/// Constraint of each entry of the state.
struct Constraints {
  static constexpr int kFixed = -1;  ///< stays zero
  /// Follows component k of the tip's translation: vertices that stick to the tip, and the tip's
  /// own entries.
  static constexpr int tip(int k) { return -2 - k; }
  static constexpr int kFree = 0;
  /// Free, and the last entry of one element only: eliminated before the factorisation.
  static constexpr int kInternal = 1;

  std::vector<int> entries;  ///< kFree, kInternal, kFixed or tip(k) of each entry of the state
  int pressures = 0;         ///< kFree entries that are pressures
};

/// Equilibrium equations of a sum of energies, with the tip's translation t (3) as parameter:
///
///     [ K_ff  K_ft ] [ df ]   [ -r_f ]        r: derivative of the energy
///     [ K_tf  K_tt ] [ dt ] = [  dR  ]        R = r_t: the force on the tip that holds it there, N
///
/// The tip's translation is given and not solved for, because a pipette is rigid beside a cell and its drive holds its
/// position. Vertices that stick to a disc follow t as constraints, which needs no penalty and gives the force as a sum
/// of their residuals; a rounded tip acts on t through the energy of its contact. The elimination of all unknowns but t
/// leaves the 3 x 3 contact stiffness, with which a live cell extrapolates between two solutions.
///
/// Entries of the state are numbered once:
///
///     state     | u of the body ........................ | pressures ...... | t_x   t_y   t_z   |
///     unknown_  | 0 1 2 tip(0) tip(1) tip(2) kFixed 3 .. | m-1 or internal  | tip(0) ... tip(2) |
///
///     free      | 0 ............ matrix_size_ | internal ............ free_size_ |
///                 in K_ff                       eliminated in their elements
///
/// P2-P0's pressures are internal: once each of them is eliminated in its element (static condensation), K_ff is
/// positive definite at a stable equilibrium, and Cholesky's factorisation is itself the test of stability. Continuous
/// pressures stay in K_ff, which is then indefinite; SymmetricSolver counts the negative pivots instead.
///
/// The pattern of K_ff and its symbolic factorisation are computed once. One thread at a time.
class EquilibriumSystem {
 public:
  using Terms = std::vector<std::shared_ptr<EnergyTerm>>;

  /// Throws std::invalid_argument when nothing is free. @pre constraints.entries has one value for each entry of the
  /// state, and the tip's three entries are at its end; an internal entry is the last one of exactly one element
  EquilibriumSystem(Terms terms, Constraints constraints, SymmetricSolver::Method method);

  int freeSize() const { return free_size_; }
  int pressures() const { return pressures_; }  ///< of the free entries
  int stateSize() const { return static_cast<int>(unknown_.size()); }
  const Terms& terms() const { return terms_; }

  /// state += (free entries, translation of the tip).
  void addTo(Eigen::VectorXd& state, const Eigen::VectorXd& free, const Eigen::Vector3d& translation) const;

  /// False when the state is not admissible.
  bool energy(const Eigen::VectorXd& state, double& energy);

  /// r_f and R; false when the state is not admissible.
  bool residual(const Eigen::VectorXd& state, Eigen::VectorXd& free, Eigen::Vector3d& reaction);

  /// Moves the internal entries to their stationary values, if the energy is quadratic in each of
  /// them, as it is in a pressure. @pre assemble() returned true once. False when the state is not
  /// admissible.
  bool settleInternal(Eigen::VectorXd& state);

  /// The tangent K_ff, K_ft and K_tt; false when the state is not admissible.
  bool assemble(const Eigen::VectorXd& state);

  /// Assembles the tangent and factorises K_ff. False when `state` is not stable (K_ff, its
  /// pressures eliminated, is not positive definite) or not admissible: then solve() and
  /// stiffness() must not be called.
  bool factorise(const Eigen::VectorXd& state);

  /// Gives the last factorisation the tangent of this state in the elements that are not smooth
  /// (EnergyTerm::isNonsmooth): the contact. All others keep theirs. Costs a small part of a
  /// factorisation. False when this changes nothing to speak of, or is not possible: then
  /// factorise() is needed. @pre factorise() returned true.
  bool refresh(const Eigen::VectorXd& state);

  /// K_ff^-1 right_hand_side, with the last factorisation.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_hand_side);

  /// -K_ff^-1 K_ft: derivative of the free entries by the translation at equilibrium (free size x
  /// 3).
  const Eigen::MatrixXd& sensitivity() const { return sensitivity_; }

  /// dR/dt at equilibrium, K_tt - K_tf K_ff^-1 K_ft, N/m; symmetric.
  const Eigen::Matrix3d& stiffness() const { return stiffness_; }

  /// K_ff of the last assemble() or factorise(), lower triangle, internal entries eliminated.
  const Eigen::SparseMatrix<double>& matrix() const { return matrix_; }

 private:
  struct Occurrence;
  /// The row of an internal unknown in its element's Hessian.
  struct Internal {
    const std::vector<int>* entries = nullptr;
    Eigen::VectorXd row;  ///< of the element's other entries
    double pivot = 0;
  };
  void number(const Constraints& constraints);
  bool inMatrix(int unknown) const { return unknown >= 0 && unknown < matrix_size_; }
  std::vector<std::vector<Occurrence>> occurrences();
  void buildPattern();
  void scatter(const std::vector<int>& entries, const Eigen::MatrixXd& hessian, const int* slot);
  void eliminate(const std::vector<int>& entries, Eigen::MatrixXd& hessian);
  void condenseTip();
  void addConstrained(int row, int column, double value, bool diagonal);

  Terms terms_;
  int free_size_ = 0;    ///< unknowns, internal ones at the end
  int matrix_size_ = 0;  ///< unknowns that are not internal
  int pressures_ = 0;
  std::vector<int> unknown_;  ///< of each entry of the state: free unknown, or as in Constraints
  Eigen::SparseMatrix<double> matrix_;
  std::vector<int> slots_;  ///< index in matrix_'s values of each pair of each element's entries: see pairIndex
  std::vector<Internal> internal_;
  SymmetricSolver solver_;
  std::unique_ptr<NonsmoothTangent> nonsmooth_;
  Eigen::MatrixXd factorised_contact_;  ///< of NonsmoothTangent, in the last factorisation; empty: not known
  Eigen::MatrixXd present_contact_;     ///< same, after the last refresh
  Eigen::MatrixXd coupling_;            ///< K_ft
  Eigen::Matrix3d tip_stiffness_ = Eigen::Matrix3d::Zero();
  Eigen::MatrixXd sensitivity_;
  Eigen::Matrix3d stiffness_ = Eigen::Matrix3d::Zero();
  LocalEnergy local_;
};

}  // namespace microinjection
