#include "cell/mechanics/relaxation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace microinjection {
namespace {

constexpr double kStepTolerance = 1e-10;  ///< of the last step of Newton's method, relative to the length
constexpr double kSmallestShift = 1e-4;   ///< larger than zero
constexpr double kLargestShift = 1e10;
constexpr double kShiftFactor = 4;
constexpr double kDecrease = 1e-4;         ///< of the energy, relative to the decrease that the slope predicts
constexpr int kMaximumShareHalvings = 20;  ///< of a line search
constexpr int kInverseIterations = 20;

double raised(double shift) { return std::max(kSmallestShift, kShiftFactor * shift); }
double lowered(double shift) { return shift <= kSmallestShift ? 0 : shift / kShiftFactor; }

}  // namespace

Relaxation::Relaxation(EquilibriumSystem& system, const RelaxationConfig& config)
    : system_(system), config_(config), solver_(SymmetricSolver::Method::kSimplicial) {
  if (system.pressures() > 0) throw std::invalid_argument("with pressures the energy at rest is not minimal");
  if (!system.assemble(Eigen::VectorXd::Zero(system.stateSize()))) {
    throw std::invalid_argument("the undeformed state is not admissible");
  }
  diagonal_ = system.matrix().diagonal().cwiseAbs();
  const double stiffest = diagonal_.maxCoeff();
  diagonal_ = diagonal_.cwiseMax(1e-9 * stiffest);
  rounding_ = 1e-14 * stiffest * config.length * config.length;
  solver_.analyse(system.matrix());
}

Relaxation::Result Relaxation::relax(Eigen::VectorXd& state) {
  Result result;
  shift_ = 0;
  if (!evaluate(state, energy_) || !differentiate(state, gradient_)) {
    result.reason = "the energy is not defined in the state to start from";
    return result;
  }
  result.reason = "the iterations allowed were not enough";
  while (!result.converged && result.iterations < config_.maximum_iterations) {
    const bool stationary = isStationary();
    if (stationary) shift_ = 0;  // checks stability
    if (!system_.assemble(state) || !factorise(result)) break;
    Eigen::VectorXd direction = -solver_.solve(gradient_);
    result.converged = shift_ == 0 && direction.cwiseAbs().maxCoeff() <= kStepTolerance * config_.length;
    const bool unstable = stationary && shift_ > 0;
    if (unstable) direction = softestDirection();
    const double share = descend(state, direction);
    if (share == 0 && (unstable || shift_ > kLargestShift)) {
      result.reason = unstable ? "at rest, but not stable: some motion costs no energy" : "no lower energy is found";
      break;
    }
    shift_ = share > 0.25 ? lowered(shift_) : share > 0 ? shift_ : raised(raised(shift_));
  }
  result.energy = energy_;
  if (result.converged) result.reason.clear();
  return result;
}

/// Energy as a function of the displacements alone: pressures are eliminated.
bool Relaxation::evaluate(Eigen::VectorXd& state, double& energy) {
  return system_.settleInternal(state) && system_.energy(state, energy) && std::isfinite(energy);
}

bool Relaxation::differentiate(const Eigen::VectorXd& state, Eigen::VectorXd& gradient) {
  Eigen::Vector3d reaction;
  if (!system_.residual(state, gradient, reaction)) return false;
  gradient.conservativeResize(diagonal_.size());  // the derivatives by internal entries, at the end, vanish
  return true;
}

/// Raises the shift until the tangent is positive definite.
bool Relaxation::factorise(Result& result) {
  for (; shift_ <= kLargestShift; shift_ = raised(shift_)) {
    shifted_ = system_.matrix();
    for (int i = 0; i < diagonal_.size(); ++i) {  // the first entry of each column
      shifted_.valuePtr()[shifted_.outerIndexPtr()[i]] += shift_ * diagonal_[i];
    }
    ++result.iterations;
    if (solver_.factorise(shifted_)) return true;
  }
  result.reason = "no shift makes the tangent positive definite";
  return false;
}

/// Whether the residual is negligible.
bool Relaxation::isStationary() const {
  return gradient_.cwiseQuotient(diagonal_).cwiseAbs().maxCoeff() <= kStepTolerance * config_.length;
}

/// Direction of the fastest decrease of the energy from a stationary state that is not stable, by
/// inverse iteration.
Eigen::VectorXd Relaxation::softestDirection() {
  Eigen::VectorXd direction(diagonal_.size());
  for (int i = 0; i < direction.size(); ++i) direction[i] = std::sin(1.0 + i);  // a start without symmetry
  for (int i = 0; i < kInverseIterations; ++i) {
    direction = solver_.solve(diagonal_.cwiseProduct(direction));
    direction *= config_.length / direction.cwiseAbs().maxCoeff();
  }
  return gradient_.dot(direction) > 0 ? Eigen::VectorXd(-direction) : direction;
}

/// Whether the energy falls enough: by a part of the predicted decrease or, below rounding error,
/// with a smaller residual.
bool Relaxation::isLower(Eigen::VectorXd& candidate, double promise, double& energy) {
  if (!evaluate(candidate, energy)) return false;
  const bool falls = energy < energy_ + kDecrease * promise - rounding_;
  if (!falls && energy > energy_ + rounding_) return false;
  if (!differentiate(candidate, candidate_gradient_)) return false;
  return falls || candidate_gradient_.norm() < gradient_.norm();
}

/// Applies a line search. Returns the share of the direction that was applied; 0: the state stays.
double Relaxation::descend(Eigen::VectorXd& state, const Eigen::VectorXd& direction) {
  double share = std::min(1.0, config_.length / direction.cwiseAbs().maxCoeff());
  const double slope = std::min(0.0, gradient_.dot(direction));
  Eigen::VectorXd step = Eigen::VectorXd::Zero(system_.freeSize());
  for (int i = 0; i < kMaximumShareHalvings; ++i, share /= 2) {
    Eigen::VectorXd candidate = state;
    double energy = 0;
    step.head(direction.size()) = share * direction;
    system_.addTo(candidate, step, Eigen::Vector3d::Zero());
    if (!isLower(candidate, share * slope, energy)) continue;
    state.swap(candidate);
    gradient_.swap(candidate_gradient_);
    energy_ = energy;
    return share;
  }
  return 0;
}

}  // namespace microinjection
