#include "cell/material/force_memory.h"

#include <cmath>

namespace microinjection {

ForceMemory::ForceMemory(const std::vector<PronyTerm>& terms) {
  for (const PronyTerm& term : terms) branches_.push_back({term, Eigen::Vector3d::Zero()});
}

Eigen::Vector3d ForceMemory::step(const Eigen::Vector3d& elastic, double duration) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const Eigen::Vector3d change = elastic - elastic_;
  elastic_ = elastic;
  for (Branch& branch : branches_) {
    const double ratio = duration / branch.term.relaxation_time;
    const double share = ratio > 0 ? -std::expm1(-ratio) / ratio : 1;  // share of the change that has not relaxed yet
    branch.force = std::exp(-ratio) * branch.force + branch.term.modulus_ratio * share * change;
    sum += branch.force;
  }
  return sum;
}

void ForceMemory::start(const Eigen::Vector3d& elastic, const Eigen::Vector3d& viscous) {
  elastic_ = elastic;
  double sum = 0;
  for (const Branch& branch : branches_) sum += branch.term.modulus_ratio;
  for (Branch& branch : branches_) branch.force = branch.term.modulus_ratio / sum * viscous;
}

Eigen::Vector3d ForceMemory::viscous() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Branch& branch : branches_) sum += branch.force;
  return sum;
}

void ForceMemory::reset() {
  elastic_.setZero();
  for (Branch& branch : branches_) branch.force.setZero();
}

}  // namespace microinjection
