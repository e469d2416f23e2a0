#include "cell/tensegrity/tensegrity_loading.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "cell/mechanics/relaxation.h"

namespace microinjection {
namespace {

constexpr double kFirstStep = 1.0 / 128, kLargestStep = 1.0 / 32, kSmallestStep = 1e-4;  ///< of the diameter
constexpr int kEasy = 8;                  ///< iterations: cables that go slack take some at any length
constexpr int kMostFactorisations = 300;  ///< of a snap
constexpr double kSnapStep = 2e-3;        ///< of the diameter
constexpr int kMostSnaps = 8;             ///< of one way: more is no path

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
  config.first_step = kFirstStep * config.length;
  config.largest_step = kLargestStep * config.length;
  config.smallest_step = kSmallestStep * config.length;
  config.easy = kEasy;
  config.smooth = false;  // cables go slack and taut
  return config;
}

LoadPath::Result TensegrityLoading::advance(const Eigen::Vector3d& target, double duration) {
  const double whole = (target - displacement()).norm();
  double waiting = duration;  // where there is no way to go
  const auto timeFor = [&](const Eigen::Vector3d& way) { return whole > 0 ? way.norm() / whole * duration : waiting; };
  int iterations = 0;
  for (int snaps = 0;; ++snaps) {
    LoadPath::Result result = path_->advance(target - origin_, timeFor(target - displacement()));
    iterations += result.newton_iterations;
    result.newton_iterations = iterations;
    if (result.converged) return result;
    const Eigen::Vector3d way = target - displacement();
    const double share = snaps < kMostSnaps ? snap(way, timeFor(way)) : 0;
    if (share == 0) {
      result.reason += "; no stable equilibrium was found beyond it either";
      if (structure_->config().membrane.tension == 0) result.reason += ": a membrane without tension crumples";
      return result;
    }
    if (share == 1 && displacement() == target) return {true, "", iterations};
    waiting *= 1 - share;
  }
}

/// A little further along `way` (m, in `duration`, s) than stable equilibria go, and down in energy from there, in one
/// implicit step of the time that this little takes; where that finds no rest, a shorter one, in which what is viscous
/// gives way less. Share of the way and time that is gone, 0 on failure.
double TensegrityLoading::snap(const Eigen::Vector3d& way, double duration) {
  const double furthest = std::min(1.0, kSnapStep * 2 * structure_->config().radius / way.norm());
  for (const double part : {1.0, 0.1, 0.01}) {
    const double share = part * furthest;
    bool viscous = false;
    for (const auto& term : parts_.terms) viscous = term->beginStep(share * duration) || viscous;
    if (fall(share * way, viscous)) return share;
    if (!viscous) break;
  }
  return 0;
}

/// To rest with the following nodes moved by `way`, m, in the step that the terms have begun.
bool TensegrityLoading::fall(const Eigen::Vector3d& way, bool viscous) {
  RelaxationConfig config;
  config.length = 2 * structure_->config().radius;
  config.maximum_iterations = kMostFactorisations;
  Eigen::VectorXd state = path_->state();
  system_.addTo(state, Eigen::VectorXd::Zero(system_.freeSize()), way);
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
