// How the structure finds its form: the equilibrium of prestressed cables, struts and membrane without load.

#include <algorithm>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "cell/mechanics/relaxation.h"
#include "cell/tensegrity/tensegrity_structure.h"

namespace microinjection {
namespace {

constexpr double kTolerance = 1e-9;  ///< residual, over the prestress
constexpr double kRounding = 2e-15;  ///< of a strut's stress, over Young's modulus
constexpr int kFactorisations = 80;  ///< of a relaxation, before the prestress is applied in smaller steps
constexpr int kMostWorseSteps = 6;   ///< successive Newton steps without improvement before it stops
constexpr double kSmallestPrestressStep = 1.0 / 64;  ///< of the prestress

}  // namespace

/// Relaxes the caps and the bow of each strut alone, with all strut ends held.
void TensegrityStructure::settleStruts() {
  Parts parts = makeParts(start_, 1);
  Constraints held = constraints({});
  for (const int node : ends_) {
    for (int k = 0; k < 3; ++k) held.entries[3 * node + k] = Constraints::kFixed;
  }
  EquilibriumSystem system(parts.terms, held, SymmetricSolver::Method::kSimplicial);
  RelaxationConfig config;
  config.length = 2 * config_.radius;
  config.maximum_iterations = kFactorisations;  // an approximation suffices: the last digits may take very long
  form_.iterations += Relaxation(system, config).relax(start_).iterations;
}

void TensegrityStructure::findForm() {
  settleStruts();
  double done = 0, step = 1;
  while (done < 1) {
    Eigen::VectorXd state = start_;
    const double next = std::min(1.0, done + step);
    if (balance(state, next)) {
      start_.swap(state);
      done = next;
      step *= 2;
      continue;
    }
    step /= 2;
    if (step >= kSmallestPrestressStep) continue;
    char text[120];
    std::snprintf(text, sizeof(text), "the tensegrity cell has no stable equilibrium beyond %.3g of its prestress",
                  done);
    throw std::runtime_error(text);
  }
}

/// Full steps of Newton's method, also when a step makes the residual larger (cables that alternate
/// between slack and taut), as long as one of the last steps improved it. False when the final
/// state is not stable.
bool TensegrityStructure::refine(EquilibriumSystem& system, Eigen::VectorXd& state) {
  Eigen::VectorXd at = state, residual;
  Eigen::Vector3d reaction;
  form_.residual = std::numeric_limits<double>::infinity();
  bool stable = false;
  for (int i = 0, worse = 0; worse < kMostWorseSteps; ++i, ++form_.iterations) {
    if (!system.residual(at, residual, reaction)) break;
    const double size = residual.lpNorm<Eigen::Infinity>();
    const bool better = size < form_.residual;
    if (!system.factorise(at)) break;
    worse = better ? 0 : worse + 1;
    if (better) {
      stable = true;
      state = at;
      form_.residual = size;
    }
    system.addTo(at, -system.solve(residual), Eigen::Vector3d::Zero());
  }
  return stable;
}

/// Relaxation approaches the equilibrium from any state (bent struts, a cut cable). Newton's method
/// then converges to rounding.
bool TensegrityStructure::balance(Eigen::VectorXd& state, double tightness) {
  Parts parts = makeParts(state, tightness);
  EquilibriumSystem system(parts.terms, constraints({}), SymmetricSolver::Method::kSimplicial);
  RelaxationConfig relaxation;
  relaxation.length = 2 * config_.radius;
  relaxation.maximum_iterations = kFactorisations;
  form_.iterations += Relaxation(system, relaxation).relax(state).iterations;
  const bool stable = refine(system, state);
  form_.prestress = 0;
  for (int i = 0; i < parts.cables->elementCount(); ++i) {
    form_.prestress = std::max(form_.prestress, parts.cables->tension(i, state));
  }
  system.energy(state, form_.energy);
  const FilamentConfig& filaments = config_.microtubules.filaments;
  const double face = geometry_.strut_length / config_.microtubules.slices * 2 * filaments.radius();
  const double rounding = kRounding * filaments.young_modulus * face;
  return stable && form_.residual <= std::max(kTolerance * form_.prestress, rounding);
}

}  // namespace microinjection
