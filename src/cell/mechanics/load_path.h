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
  double smallest_step = 56e-6 * 1e-5;  ///< m: a path that needs less has ended
  int easy = 5;                         ///< iterations of a step after which a longer one is tried
  bool linear = false;                  ///< one step at any length; nothing to check
  bool smooth = true;  ///< the force is a smooth function of the tip's place on a branch: no contact comes or goes
};

/// Follows the stable equilibria of a system while the tip is translated: predictor from the tangent, Newton's method
/// with line search, adaptive load steps. A step counts only when it ends in a state whose tangent is positive definite
/// and, on a smooth branch, whose energy is what the tip's work made it; else a branch was lost or jumped, and the step
/// is cut. Keeps its state and continues from it. One thread at a time.
class LoadPath {
 public:
  struct Result {
    bool converged = false;
    std::string reason;  ///< why not; empty when converged
    int newton_iterations = 0;
  };

  /// `system` must outlive this and be undeformed. Throws std::invalid_argument when it is not stable so: something is
  /// not held, or a layer's tension is too much for its material. `start`: the equilibrium to set out from, where it is
  /// not the state of zeros (a prestressed structure); the tip's translation counts from there, and the terms
  /// accept it. `viscous`: it is one of the step that the terms were last told to begin, which took a finite time.
  LoadPath(EquilibriumSystem& system, const LoadPathConfig& config, const Eigen::VectorXd& start = {},
           bool viscous = false);

  /// Straight and at constant speed from the present translation to `target`, m, in `duration`, s; infinite: nothing
  /// viscous resists. Already there, it waits for that long. On failure the state is the last equilibrium found on the
  /// way.
  Result advance(const Eigen::Vector3d& target, double duration = std::numeric_limits<double>::infinity());

  /// Back to the state that it set out from.
  void reset();

  const Eigen::VectorXd& state() const { return state_.x; }                  ///< see EnergyTerm
  const Eigen::Vector3d& translation() const { return state_.translation; }  ///< m, of the tip
  const Eigen::Vector3d& reaction() const { return state_.reaction; }        ///< N, that holds the tip there
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
  bool balance(State& trial, int& iterations, std::string& reason);
  bool correct(State& trial);
  bool workMatches(const State& trial) const;
  bool refactorise(const State& state);
  bool settle(int& iterations, std::string& reason);

  EquilibriumSystem& system_;
  LoadPathConfig config_;
  double force_floor_ = 0;  ///< N, residual that is nothing but rounding
  State state_, trial_, undeformed_;
  Eigen::VectorXd residual_, candidate_, candidate_residual_;
  double load_step_;         ///< m, tried next
  bool viscous_ = false;     ///< the last step took a finite time: the state is no equilibrium of an infinite one
  bool factorised_ = false;  ///< of a state near enough for chord iterations
};

}  // namespace microinjection
