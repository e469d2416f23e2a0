#pragma once

#include <array>
#include <vector>

#include "cell/mechanics/energy_term.h"

namespace microinjection {

/// Resists spinning of struts about the line through their hinges, which no other term does. For
/// each pair of nodes (two corners of a strut's middle section) the energy is k/2 |u_a - u_b -
/// start|^2. This is a regularisation: k must be so small that the moment is negligible against the
/// strut's bending stiffness.
class SpinStop : public EnergyTerm {
 public:
  /// @param stiffness k, N/m
  SpinStop(const std::vector<std::array<int, 2>>& pairs, double stiffness, const Eigen::VectorXd& start)
      : stiffness_(stiffness) {
    for (const auto& [a, b] : pairs) {
      entries_.push_back({3 * a, 3 * a + 1, 3 * a + 2, 3 * b, 3 * b + 1, 3 * b + 2});
      starts_.emplace_back(start.segment<3>(3 * a) - start.segment<3>(3 * b));
    }
  }

  int elementCount() const override { return static_cast<int>(entries_.size()); }
  const std::vector<int>& entries(int pair) const override { return entries_[pair]; }

  bool evaluate(int pair, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override {
    const std::vector<int>& at = entries_[pair];
    const Eigen::Vector3d stretch = state.segment<3>(at[0]) - state.segment<3>(at[3]) - starts_[pair];
    result.zero = false;
    result.energy = 0.5 * stiffness_ * stretch.squaredNorm();
    if (order == Order::kEnergy) return true;
    result.gradient.resize(6);
    result.gradient << stiffness_ * stretch, -stiffness_ * stretch;
    if (order == Order::kGradient) return true;
    const Eigen::Matrix3d block = stiffness_ * Eigen::Matrix3d::Identity();
    result.hessian.resize(6, 6);
    result.hessian << block, -block, -block, block;
    return true;
  }

 private:
  double stiffness_;
  std::vector<std::vector<int>> entries_;
  std::vector<Eigen::Vector3d> starts_;  ///< m
};

}  // namespace microinjection
