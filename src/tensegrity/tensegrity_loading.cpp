#include "tensegrity/tensegrity_loading.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "mechanics/relaxation.h"

namespace microinjection {
namespace {

constexpr double kFirstStep = 1.0 / 128, kLargestStep = 1.0 / 32, kSmallestStep = 1e-4;  ///< of the diameter
constexpr int kEasy = 8;                  ///< iterations: cables that go slack take some at any length
constexpr int kMostFactorisations = 300;  ///< of a snap
constexpr double kSnapStep = 2e-3;        ///< of the diameter

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
  int iterations = 0;
  while (true) {
    const double left = (target - displacement()).norm();
    LoadPath::Result result = path_->advance(target - origin_, whole > 0 ? left / whole * duration : duration);
    iterations += result.newton_iterations;
    result.newton_iterations = iterations;
    if (result.converged || !snap(target - displacement())) return result;
    if (displacement() == target) return {true, "", iterations};
  }
}

/// A little further along `way` than stable equilibria go, and down in energy from there.
bool TensegrityLoading::snap(const Eigen::Vector3d& way) {
  RelaxationConfig config;
  config.length = 2 * structure_->config().radius;
  config.maximum_iterations = kMostFactorisations;
  const double further = std::min(1.0, kSnapStep * config.length / way.norm());
  Eigen::VectorXd state = path_->state();
  system_.addTo(state, Eigen::VectorXd::Zero(system_.freeSize()), further * way);
  if (!Relaxation(system_, config).relax(state).converged) return false;
  try {
    path_ = std::make_unique<LoadPath>(system_, pathConfig(), state);
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
