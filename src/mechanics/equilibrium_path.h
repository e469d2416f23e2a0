#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mechanics/elastic_body.h"
#include "mechanics/patch_system.h"

namespace microinjection {

/// Follows the stable equilibria of an elastic body while a rigid patch of its vertices is translated: predictor from
/// the tangent, Newton's method with line search, adaptive load steps. A step counts only when it ends in a state whose
/// tangent is positive definite and whose energy is what the patch's work made it; else a branch was lost or jumped,
/// and the step is cut. Keeps its state and continues from it. One thread at a time.
class EquilibriumPath {
 public:
  struct Result {
    bool converged = false;
    std::string reason;  ///< why not; empty when converged
    int newton_iterations = 0;
  };

  /// `held` vertices do not move; those of `patch` move by the translation. `length` is the size of the body, m: 1e-5
  /// of it is the smallest load step. `body` must outlive this. Throws std::invalid_argument as PatchSystem does.
  EquilibriumPath(const ElasticBody& body, const std::vector<int>& held, const std::vector<int>& patch, double length);

  /// Straight from the present translation to `target`, m. On failure the state is the last equilibrium found on the
  /// way.
  Result advance(const Eigen::Vector3d& target);

  /// Back to the undeformed state.
  void reset();

  const Eigen::VectorXd& displacement() const { return state_.u; }              ///< m, xyz per vertex
  const Eigen::Vector3d& translation() const { return state_.translation; }     ///< m, of the patch
  const Eigen::Vector3d& reaction() const { return state_.reaction; }           ///< N, that holds the patch there
  const Eigen::Matrix3d& stiffness() const { return state_.stiffness; }         ///< N/m, d(reaction)/d(translation)
  double energy() const { return state_.energy; }                               ///< J
  double smallestJacobian() const { return body_.smallestJacobian(state_.u); }  ///< min det F

 private:
  /// A stable equilibrium with its first derivatives.
  struct State {
    Eigen::VectorXd u;
    Eigen::Vector3d translation = Eigen::Vector3d::Zero();
    Eigen::Vector3d reaction = Eigen::Vector3d::Zero();
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, Eigen::Dynamic, 3> sensitivity;
    double energy = 0;
  };

  /// Tries one load step; fills `reason` and leaves the state when it fails.
  bool step(const Eigen::Vector3d& increment, int& iterations, std::string& reason);
  bool balance(State& trial, int& iterations, std::string& reason);
  bool correct(State& trial);
  bool admissible(const Eigen::VectorXd& u) const;
  bool workMatches(const State& trial) const;
  bool refactorise(const State& state);

  const ElasticBody& body_;
  PatchSystem system_;
  double length_;
  double force_floor_ = 0;  ///< N, residual that is nothing but rounding
  State state_, trial_;
  State undeformed_;
  Eigen::VectorXd residual_, candidate_, candidate_residual_;
  double load_step_;         ///< m, tried next
  bool factorised_ = false;  ///< of a state near enough for chord iterations
};

}  // namespace microinjection
