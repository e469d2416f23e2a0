#include "cell/tensegrity/cables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace microinjection {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

Cables::Cables(std::shared_ptr<const NodePositions> node_positions, std::vector<Cable> cables,
               const Eigen::VectorXd& start)
    : node_positions_(std::move(node_positions)), cables_(std::move(cables)), duration_(kInfinite) {
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    const Cable& cable = cables_[i];
    if (!(cable.rest_length > 0) || !(cable.axial_stiffness >= 0) || !(cable.retardation_time >= 0)) {
      throw std::invalid_argument("cable " + std::to_string(i) +
                                  ": rest length must be positive, stiffness and retardation time not negative");
    }
    entries_.emplace_back();
    for (const int node : {cable.a, cable.b}) {
      for (int k = 0; k < 3; ++k) entries_.back().push_back(3 * node + k);
    }
    lengths_.push_back(std::max(length(static_cast<int>(i), start), cable.rest_length));
  }
  start_lengths_ = accepted_ = lengths_;
}

Cables::Spring Cables::spring(int index) const {
  const Cable& cable = cables_[index];
  const double elastic = cable.axial_stiffness / cable.rest_length;
  const double viscous = std::isfinite(duration_) ? elastic * cable.retardation_time / duration_ : 0;
  if (viscous == 0) return {elastic, cable.rest_length};
  return {elastic + viscous, (elastic * cable.rest_length + viscous * lengths_[index]) / (elastic + viscous)};
}

double Cables::length(int index, const Eigen::VectorXd& state) const {
  const Cable& cable = cables_[index];
  const Eigen::Vector3d from = (*node_positions_)[cable.a] + state.segment<3>(3 * cable.a);
  const Eigen::Vector3d to = (*node_positions_)[cable.b] + state.segment<3>(3 * cable.b);
  return (to - from).norm();
}

double Cables::tension(int index, const Eigen::VectorXd& state) const {
  const Spring spring = this->spring(index);
  return std::max(0.0, spring.stiffness * (length(index, state) - spring.slack_length));
}

bool Cables::evaluate(int index, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const {
  const Cable& cable = cables_[index];
  const Eigen::Vector3d from = (*node_positions_)[cable.a] + state.segment<3>(3 * cable.a);
  const Eigen::Vector3d span = (*node_positions_)[cable.b] + state.segment<3>(3 * cable.b) - from;
  const double length = span.norm();
  if (!(length > 0)) return false;
  const Spring spring = this->spring(index);
  const double stretch = length - spring.slack_length;
  result.zero = stretch <= 0;
  if (result.zero) return true;
  const double tension = spring.stiffness * stretch;
  result.energy = 0.5 * tension * stretch;
  if (order == Order::kEnergy) return true;
  const Eigen::Vector3d direction = span / length;
  result.gradient.resize(6);
  result.gradient << -tension * direction, tension * direction;
  if (order == Order::kGradient) return true;
  const Eigen::Matrix3d along = direction * direction.transpose();
  const Eigen::Matrix3d block = spring.stiffness * along + tension / length * (Eigen::Matrix3d::Identity() - along);
  result.hessian.resize(6, 6);
  result.hessian << block, -block, -block, block;
  return true;
}

bool Cables::beginStep(double duration) {
  duration_ = duration;
  lengths_ = accepted_;
  const bool viscous =
      std::any_of(cables_.begin(), cables_.end(), [](const Cable& cable) { return cable.retardation_time > 0; });
  return viscous && std::isfinite(duration);
}

void Cables::accept(const Eigen::VectorXd& state) {
  for (std::size_t i = 0; i < cables_.size(); ++i) {
    const int index = static_cast<int>(i);
    accepted_[i] = std::max(length(index, state), spring(index).slack_length);
  }
}

void Cables::reset() {
  lengths_ = accepted_ = start_lengths_;
  duration_ = kInfinite;
}

}  // namespace microinjection
