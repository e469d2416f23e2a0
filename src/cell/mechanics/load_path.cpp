#include "cell/mechanics/load_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace microinjection {
namespace {

constexpr double kResidualTolerance = 1e-8;  ///< of the residual, relative to the reaction
constexpr double kRounding = 1e-13;          ///< of the residual, relative to stiffness times length
constexpr double kWorkMismatch = 1e-3;       ///< of the energy, relative to the work of the step
constexpr double kSlow = 0.2;                ///< contraction above which an old factorisation is discarded
constexpr double kFar = 0.05;            ///< residual, relative to the reaction, above which an old one is not tried
constexpr int kMaximumIterations = 15;   ///< a step that needs more is shortened
constexpr int kMaximumStepHalvings = 8;  ///< of a line search

}  // namespace

LoadPath::LoadPath(EquilibriumSystem& system, const LoadPathConfig& config, const Eigen::VectorXd& start, bool viscous)
    : system_(system), config_(config), load_step_(config.first_step), viscous_(viscous) {
  undeformed_.x.setZero(system.stateSize());
  if (start.size() > 0) {
    undeformed_.x = start;
    system_.residual(start, residual_, undeformed_.reaction);
  }
  if (!refactorise(undeformed_)) throw std::invalid_argument("the undeformed state is not stable");
  undeformed_.stiffness = system_.stiffness();
  undeformed_.sensitivity = system_.sensitivity();
  if (start.size() > 0) system_.energy(start, undeformed_.energy);
  force_floor_ = kRounding * config.length * system_.matrix().diagonal().maxCoeff();
  state_ = undeformed_;
  if (start.size() > 0) {
    for (const auto& term : system_.terms()) term->accept(start);
  }
}

void LoadPath::reset() {
  for (const auto& term : system_.terms()) term->reset();
  state_ = undeformed_;
  viscous_ = false;
  load_step_ = config_.first_step;
  refactorise(undeformed_);  // so that later results are identical to those of a new path
}

bool LoadPath::refactorise(const State& state) {
  factorised_ = system_.factorise(state.x);
  return factorised_;
}

/// In most iterations that need another tangent, only the contact has changed.
bool LoadPath::improveTangent(const State& trial) {
  return (factorised_ && system_.refresh(trial.x)) || refactorise(trial);
}

LoadPath::Result LoadPath::advance(const Eigen::Vector3d& target, double duration) {
  Result result;
  double remaining_time = duration;
  bool waiting = target == state_.translation && (std::isfinite(duration) || viscous_);
  while (waiting || target != state_.translation) {
    const Eigen::Vector3d remaining = target - state_.translation;
    const double distance = remaining.norm();
    const bool whole = load_step_ > (1 - 1e-6) * distance || config_.linear;  // leaves no tiny last step
    const double share = whole ? 1 : load_step_ / distance;
    const Eigen::Vector3d increment = whole ? remaining : Eigen::Vector3d(share * remaining);
    const int before = result.newton_iterations;
    if (step(increment, share * remaining_time, result.newton_iterations, result.reason)) {
      waiting = false;
      remaining_time -= std::isfinite(remaining_time) ? share * remaining_time : 0;
      if (whole) state_.translation = target;
      const bool easy = result.newton_iterations - before <= config_.easy;
      if (easy && !whole) load_step_ = std::min(2 * load_step_, config_.largest_step);
      continue;
    }
    load_step_ = std::min(load_step_, distance) / 2;
    if (config_.linear || load_step_ < config_.smallest_step) {
      load_step_ = config_.largest_step;
      return result;
    }
  }
  result.converged = true;
  result.reason.clear();
  return result;
}

bool LoadPath::step(const Eigen::Vector3d& increment, double duration, int& iterations, std::string& reason) {
  bool viscous = false;
  for (const auto& term : system_.terms()) viscous = term->beginStep(duration) || viscous;
  const bool other = viscous || viscous_;
  if (other) {  // the energy function is now that of this step
    factorised_ = false;
    system_.energy(state_.x, state_.energy);
  }
  trial_ = state_;
  system_.addTo(trial_.x, state_.sensitivity * increment, increment);
  trial_.translation += increment;
  if (!balance(trial_, iterations, reason) || !settle(iterations, reason)) return false;
  system_.energy(trial_.x, trial_.energy);
  if (!config_.linear) {
    if (!refactorise(trial_)) {
      reason = "the equilibrium is not stable: its tangent is not positive definite";
      return false;
    }
    trial_.stiffness = system_.stiffness();
    trial_.sensitivity = system_.sensitivity();
  }
  // A viscous step dissipates. Its energy's derivative at the start is not the force at the end of
  // the last step.
  if (config_.smooth && !other && !workMatches(trial_)) {
    reason = "the branch of stable equilibria ends: the next one is not reached continuously";
    factorised_ = false;
    return false;
  }
  std::swap(state_, trial_);
  viscous_ = viscous;
  for (const auto& term : system_.terms()) term->accept(state_.x);
  return true;
}

bool LoadPath::settle(int& iterations, std::string& reason) {
  bool changed = false;
  for (const auto& term : system_.terms()) changed = term->settle(trial_.x) || changed;
  return !changed || balance(trial_, iterations, reason, true);
}

bool LoadPath::balance(State& trial, int& iterations, std::string& reason, bool other_contact) {
  if (!system_.residual(trial.x, residual_, trial.reaction)) {
    reason = "an element would be inverted, or stretched beyond what its material bears";
    return false;
  }
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kMaximumIterations; ++i) {
    const double norm = residual_.norm();
    if (norm <= std::max(kResidualTolerance * trial.reaction.norm(), force_floor_)) return true;
    const bool far = i == 0 && (other_contact || norm > kFar * trial.reaction.norm());  // it has another contact
    if ((!factorised_ || far || norm > kSlow * last) && !improveTangent(trial)) {
      reason = "no stable equilibrium: the tangent along the step is not positive definite";
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

/// The residual may grow when points come into contact, as long as the energy falls.
bool LoadPath::correct(State& trial) {
  const Eigen::VectorXd direction = -system_.solve(residual_);
  const double norm = residual_.norm();
  double before = 0, after = 0;
  system_.energy(trial.x, before);
  double scale = 1;
  for (int i = 0; i < kMaximumStepHalvings; ++i, scale /= 2) {
    candidate_ = trial.x;
    system_.addTo(candidate_, scale * direction, Eigen::Vector3d::Zero());
    if (!system_.residual(candidate_, candidate_residual_, trial.reaction)) continue;
    const bool nearer = candidate_residual_.norm() < norm;
    if (!nearer && !(system_.energy(candidate_, after) && after < before)) continue;
    trial.x.swap(candidate_);
    residual_.swap(candidate_residual_);
    return true;
  }
  return false;
}

bool LoadPath::workMatches(const State& trial) const {
  if (config_.linear) return true;
  // Hermite's rule: exact to fourth order in the step on a smooth branch.
  const Eigen::Vector3d step = trial.translation - state_.translation;
  const double work =
      0.5 * step.dot(state_.reaction + trial.reaction) + step.dot((state_.stiffness - trial.stiffness) * step) / 12;
  const double scale = std::abs(step.dot(state_.stiffness * step)) + std::abs(work);
  const double rounding = force_floor_ * config_.length;
  return std::abs(trial.energy - state_.energy - work) <= kWorkMismatch * scale + rounding;
}

}  // namespace microinjection
