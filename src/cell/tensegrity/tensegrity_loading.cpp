#include "cell/tensegrity/tensegrity_loading.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "cell/mechanics/relaxation.h"

namespace microinjection {
namespace {

constexpr double kFirstIndentation = 1.0 / 128, kLargestIndentation = 1.0 / 32,
                 kSmallestIndentation = 1e-4;  ///< of the diameter
constexpr int kEasy = 8;                  ///< iterations: cables that become slack need some in steps of any length
constexpr int kMostFactorisations = 300;  ///< in a snap
constexpr double kSnapStep = 2e-3;        ///< of the diameter
constexpr int kMostSnaps = 8;             ///< of one call; more indicates that there is no path

}  // namespace

TensegrityLoading::TensegrityLoading(std::shared_ptr<const TensegrityStructure> structure,
                                     const std::vector<int>& following)
    : structure_(std::move(structure)),
      parts_(structure_->makeParts()),
      system_(parts_.terms, structure_->constraints(following), SymmetricSolver::Method::kSimplicial),
      path_(std::make_unique<LoadPath>(system_, pathConfig(), structure_->start())) {}

LoadPathConfig TensegrityLoading::pathConfig() const {
  LoadPathConfig config;
  config.length = 2 * structure_->config().radius;
  config.first_step = kFirstIndentation * config.length;
  config.largest_step = kLargestIndentation * config.length;
  config.smallest_step = kSmallestIndentation * config.length;
  config.easy = kEasy;
  config.smooth = false;  // cables become slack and taut
  return config;
}

LoadPath::Result TensegrityLoading::advance(const Eigen::Vector3d& target, double duration) {
  const double whole = (target - displacement()).norm();
  double waiting = duration;  // duration at a zero distance
  const auto timeFor = [&](const Eigen::Vector3d& path) {
    return whole > 0 ? path.norm() / whole * duration : waiting;
  };
  int iterations = 0;
  for (int snaps = 0;; ++snaps) {
    LoadPath::Result result = path_->advance(target - origin_, timeFor(target - displacement()));
    iterations += result.newton_iterations;
    result.newton_iterations = iterations;
    if (result.converged) return result;
    const Eigen::Vector3d remaining = target - displacement();
    const double share = snaps < kMostSnaps ? snap(remaining, timeFor(remaining)) : 0;
    if (share == 0) {
      result.reason += "; no stable equilibrium was found beyond it either";
      if (structure_->config().membrane.tension == 0) result.reason += ": a membrane without tension crumples";
      return result;
    }
    if (share == 1 && displacement() == target) return {true, "", iterations};
    waiting *= 1 - share;
  }
}

/// Moves a little along `path` (m, in `duration`, s) beyond the last stable equilibrium and
/// minimises the energy from there, in one implicit step of the corresponding time. If that finds
/// no rest, it tries shorter steps, in which viscous parts resist more. Returns the share of the
/// path and time that was covered, 0 on failure.
double TensegrityLoading::snap(const Eigen::Vector3d& path, double duration) {
  const double furthest = std::min(1.0, kSnapStep * 2 * structure_->config().radius / path.norm());
  for (const double part : {1.0, 0.1, 0.01}) {
    const double share = part * furthest;
    bool viscous = false;
    for (const auto& term : parts_.terms) viscous = term->beginStep(share * duration) || viscous;
    if (relax(share * path, viscous)) return share;
    if (!viscous) break;
  }
  return 0;
}

/// Relaxes with the following nodes moved by `increment`, m, in the step that the terms have begun.
bool TensegrityLoading::relax(const Eigen::Vector3d& increment, bool viscous) {
  RelaxationConfig config;
  config.length = 2 * structure_->config().radius;
  config.maximum_iterations = kMostFactorisations;
  Eigen::VectorXd state = path_->state();
  system_.addTo(state, Eigen::VectorXd::Zero(system_.freeSize()), increment);
  if (!Relaxation(system_, config).relax(state).converged) return false;
  try {
    path_ = std::make_unique<LoadPath>(system_, pathConfig(), state, viscous);
  } catch (const std::invalid_argument&) {  // at rest, but not stable
    return false;
  }
  origin_ = displacement();
  ++snaps_;
  return true;
}

void TensegrityLoading::reset() {
  for (const auto& term : parts_.terms) term->reset();
  path_ = std::make_unique<LoadPath>(system_, pathConfig(), structure_->start());
  origin_.setZero();
  snaps_ = 0;
}

}  // namespace microinjection
