#include "cell/mechanics/proximal_anchor.h"

#include <utility>

namespace microinjection {
namespace {

Eigen::VectorXd displacement(const std::vector<int>& entries, const Eigen::VectorXd& state) { return state(entries); }

}  // namespace

ProximalAnchor::ProximalAnchor(std::vector<std::vector<int>> entries, std::vector<double> weights, double stiffness)
    : entries_(std::move(entries)), stiffness_(std::move(weights)) {
  for (double& each : stiffness_) each *= stiffness;
  reset();
}

bool ProximalAnchor::evaluate(int node, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  const Eigen::VectorXd stretch = displacement(entries_[node], state) - anchor_[node];
  result.zero = false;
  result.energy = 0.5 * stiffness_[node] * stretch.squaredNorm();
  if (order != Order::kEnergy) result.gradient = stiffness_[node] * stretch;
  if (order == Order::kHessian)
    result.hessian = stiffness_[node] * Eigen::MatrixXd::Identity(stretch.size(), stretch.size());
  return true;
}

bool ProximalAnchor::beginStep(double /*duration*/) {
  anchor_ = accepted_;
  return false;
}

bool ProximalAnchor::settle(const Eigen::VectorXd& state) {
  for (std::size_t node = 0; node < entries_.size(); ++node) anchor_[node] = displacement(entries_[node], state);
  return true;
}

void ProximalAnchor::accept(const Eigen::VectorXd& /*state*/) { accepted_ = anchor_; }

void ProximalAnchor::reset() {
  anchor_.clear();
  for (const std::vector<int>& entries : entries_)
    anchor_.push_back(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(entries.size())));
  accepted_ = anchor_;
}

Eigen::VectorXd ProximalAnchor::residualForce(const Eigen::VectorXd& state) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(entries_.front().size()));
  for (std::size_t node = 0; node < entries_.size(); ++node)
    sum -= stiffness_[node] * (displacement(entries_[node], state) - anchor_[node]);
  return sum;
}

}  // namespace microinjection
