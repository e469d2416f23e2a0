#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "cell/mechanics/equilibrium_system.h"

namespace microinjection {

struct LoadPathConfig {
  double length = 56e-6;                ///< m, size of the body
  double first_step = 56e-6 / 16;       ///< m, of the tip
  double largest_step = 56e-6 / 16;     ///< m
  double smallest_step = 56e-6 * 1e-5;  ///< m: a path that needs a smaller one has ended
  int easy = 5;                         ///< largest number of iterations after which a longer step is tried
  bool linear = false;                  ///< one step of any length, without checks
  /// The force is a smooth function of the tip's position on a branch: contact points do not
  /// change.
  bool smooth = true;
};

/// Follows the stable equilibria of a system while the tip is translated: predictor from the
/// tangent, Newton's method with line search, adaptive load steps. A step is accepted only when its
/// tangent is positive definite and, on a smooth branch, when the energy has changed by the tip's
/// work. Otherwise the branch was lost or left, and the step is halved. The path keeps its state
/// and continues from it. One thread at a time.
class LoadPath {
 public:
  struct Result {
    bool converged = false;
    std::string reason;  ///< empty when converged
    int newton_iterations = 0;
  };

  /// `system` must outlive this and be undeformed. Throws std::invalid_argument when that state is
  /// not stable: the body is not held, or a layer's tension is too large for its material. `start`:
  /// equilibrium to start from instead of the state of zeros (a prestressed structure); the tip's
  /// translation is relative to it, and the terms accept it. `viscous`: `start` belongs to the step
  /// that the terms began last, which took a finite time.
  LoadPath(EquilibriumSystem& system, const LoadPathConfig& config, const Eigen::VectorXd& start = {},
           bool viscous = false);

  /// Moves straight and at constant speed from the present translation to `target`, m, in
  /// `duration`, s; infinite: viscous stresses have relaxed. At the target, it holds for that long.
  /// On failure the state is the last equilibrium on the path.
  Result advance(const Eigen::Vector3d& target, double duration = std::numeric_limits<double>::infinity());

  /// Returns to the initial state.
  void reset();

  const Eigen::VectorXd& state() const { return state_.x; }                  ///< see EnergyTerm
  const Eigen::Vector3d& translation() const { return state_.translation; }  ///< m, of the tip
  const Eigen::Vector3d& reaction() const { return state_.reaction; }        ///< N, external, on the tip
  const Eigen::Matrix3d& stiffness() const { return state_.stiffness; }      ///< N/m, d(reaction)/d(translation)
  double energy() const { return state_.energy; }                            ///< J

 private:
  struct State {
    Eigen::VectorXd x;
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Vector3d reaction = Eigen::Vector3d::Zero();
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    Eigen::MatrixXd sensitivity;
    double energy = 0;
  };

  bool step(const Eigen::Vector3d& increment, double duration, int& iterations, std::string& reason);
  /// @param other_contact whether the contact has changed since the last factorisation
  bool balance(State& trial, int& iterations, std::string& reason, bool other_contact = false);
  bool correct(State& trial);
  bool workMatches(const State& trial) const;
  bool refactorise(const State& state);
  bool improveTangent(const State& trial);
  bool settle(int& iterations, std::string& reason);

  EquilibriumSystem& system_;
  LoadPathConfig config_;
  double force_floor_ = 0;  ///< N, residual that is only rounding
  State state_, trial_, undeformed_;
  Eigen::VectorXd residual_, candidate_, candidate_residual_;
  double load_step_;         ///< m, of the next step
  bool viscous_ = false;     ///< the last step took a finite time, so the state is no equilibrium of an infinite one
  bool factorised_ = false;  ///< of a state close enough for chord iterations
};

}  // namespace microinjection
