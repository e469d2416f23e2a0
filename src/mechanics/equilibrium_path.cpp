#include "mechanics/equilibrium_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace microinjection {
namespace {

constexpr double kTolerance = 1e-9;        ///< of the residual, relative to the reaction
constexpr double kRounding = 1e-13;        ///< of the residual, relative to stiffness times length
constexpr double kLargestStep = 1.0 / 16;  ///< of the length
constexpr double kSmallestStep = 1e-5;     ///< of the length
constexpr double kWorkMismatch = 1e-3;     ///< of the energy, relative to the work of the step
constexpr double kSlow = 0.2;              ///< contraction that is too slow to keep an old factorisation
constexpr int kMaximumIterations = 15;     ///< a step that needs more is too long
constexpr int kMaximumHalvings = 8;        ///< of a line search

}  // namespace

EquilibriumPath::EquilibriumPath(const ElasticBody& body, const std::vector<int>& held, const std::vector<int>& patch,
                                 double length)
    : body_(body), system_(body, held, patch), length_(length), load_step_(kLargestStep * length) {
  undeformed_.u.setZero(3 * body.vertexCount());
  refactorise(undeformed_);  // the undeformed state of every material is stable
  undeformed_.stiffness = system_.stiffness();
  undeformed_.sensitivity = system_.sensitivity();
  force_floor_ = kRounding * length * system_.matrix().diagonal().maxCoeff();
  state_ = undeformed_;
}

void EquilibriumPath::reset() {
  state_ = undeformed_;
  load_step_ = kLargestStep * length_;
  refactorise(undeformed_);  // so that what follows is the same, to the bit, as for a new path
}

bool EquilibriumPath::refactorise(const State& state) {
  factorised_ = system_.factorise(state.u);
  return factorised_;
}

EquilibriumPath::Result EquilibriumPath::advance(const Eigen::Vector3d& target) {
  Result result;
  while (true) {
    const Eigen::Vector3d remaining = target - state_.translation;
    const double distance = remaining.norm();
    if (distance == 0) break;
    const bool whole = load_step_ > (1 - 1e-6) * distance || body_.material().isLinear();  // no crumb for the next step
    const double length = whole ? distance : load_step_;
    const Eigen::Vector3d increment = whole ? remaining : Eigen::Vector3d(remaining * (length / distance));
    const int before = result.newton_iterations;
    if (step(increment, result.newton_iterations, result.reason)) {
      if (whole) state_.translation = target;
      const bool easy = result.newton_iterations - before <= 4;
      if (easy && !whole) load_step_ = std::min(2 * length, kLargestStep * length_);
      continue;
    }
    load_step_ = length / 2;
    if (body_.material().isLinear() || load_step_ < kSmallestStep * length_) {
      load_step_ = kLargestStep * length_;
      return result;
    }
  }
  result.converged = true;
  result.reason.clear();
  return result;
}

bool EquilibriumPath::step(const Eigen::Vector3d& increment, int& iterations, std::string& reason) {
  trial_ = state_;
  system_.addTo(trial_.u, state_.sensitivity * increment, increment);
  trial_.translation += increment;
  if (!admissible(trial_.u)) {
    reason = "an element would be inverted";
    return false;
  }
  if (!balance(trial_, iterations, reason)) return false;
  trial_.energy = body_.energy(trial_.u);
  if (!body_.material().isLinear()) {
    if (!refactorise(trial_)) {
      reason = "the equilibrium is not stable: its tangent is not positive definite";
      return false;
    }
    trial_.stiffness = system_.stiffness();
    trial_.sensitivity = system_.sensitivity();
  }
  if (!workMatches(trial_)) {
    reason = "the branch of stable equilibria ends: the next one is not reached continuously";
    factorised_ = false;
    return false;
  }
  std::swap(state_, trial_);
  return true;
}

bool EquilibriumPath::balance(State& trial, int& iterations, std::string& reason) {
  system_.residual(trial.u, residual_, trial.reaction);
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaximumIterations; ++i) {
    const double norm = residual_.norm();
    if (norm <= std::max(kTolerance * trial.reaction.norm(), force_floor_)) return true;
    if ((!factorised_ || norm > kSlow * last) && !refactorise(trial)) {
      reason = "no stable equilibrium: the tangent on the way is not positive definite";
      return false;
    }
    last = norm;
    ++iterations;
    if (!correct(trial)) {
      reason = "Newton's method does not reduce the residual";
      factorised_ = false;
      return false;
    }
  }
  reason = "Newton's method does not converge";
  factorised_ = false;
  return false;
}

bool EquilibriumPath::correct(State& trial) {
  const Eigen::VectorXd direction = -system_.solve(residual_);
  const double norm = residual_.norm();
  double scale = 1;
  for (int i = 0; i < kMaximumHalvings; ++i, scale /= 2) {
    candidate_ = trial.u;
    system_.addTo(candidate_, scale * direction, Eigen::Vector3d::Zero());
    if (!admissible(candidate_)) continue;
    system_.residual(candidate_, candidate_residual_, trial.reaction);
    if (candidate_residual_.norm() >= norm) continue;
    trial.u.swap(candidate_);
    residual_.swap(candidate_residual_);
    return true;
  }
  return false;
}

bool EquilibriumPath::admissible(const Eigen::VectorXd& u) const {
  return body_.material().isLinear() || body_.smallestJacobian(u) > 0;
}

bool EquilibriumPath::workMatches(const State& trial) const {
  if (body_.material().isLinear()) return true;
  // Hermite's rule: exact to fourth order in the step on a smooth branch.
  const Eigen::Vector3d step = trial.translation - state_.translation;
  const double work =
      0.5 * step.dot(state_.reaction + trial.reaction) + step.dot((state_.stiffness - trial.stiffness) * step) / 12;
  const double scale = std::abs(step.dot(state_.stiffness * step)) + std::abs(work);
  const double rounding = force_floor_ * length_;
  return std::abs(trial.energy - state_.energy - work) <= kWorkMismatch * scale + rounding;
}

}  // namespace microinjection
