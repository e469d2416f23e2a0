#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/mechanics/energy_term.h"

namespace microinjection {

/// Weak springs between the nodes of a body and where they were at the last equilibrium: the proximal point method
/// (Rockafellar, "Monotone operators and the proximal point algorithm", SIAM J. Control 14, 1976), for a body that
/// nothing but a contact holds. Without it the tangent of a body that just touches, or slides, has no inverse.
///
/// The springs carry no load in the end: at each equilibrium their other ends come after, and the step is solved again,
/// so that their force falls by the ratio of their stiffness to the contact's, each time. What it fell to is
/// residualForce().
class ProximalAnchor : public EnergyTerm {
 public:
  /// @param entries of the state: each node's displacement, `dimension` of them a node
  /// @param weights of the nodes; their sum is 1
  /// @param stiffness of all springs together, N/m, > 0
  ProximalAnchor(std::vector<std::vector<int>> entries, std::vector<double> weights, double stiffness);

  int elementCount() const override { return static_cast<int>(entries_.size()); }
  const std::vector<int>& entries(int node) const override { return entries_[node]; }
  bool evaluate(int node, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override;
  bool beginStep(double duration) override;
  bool settle(const Eigen::VectorXd& state) override;
  void accept(const Eigen::VectorXd& state) override;
  void reset() override;

  /// N, (dimension): of all springs on the body, at this state
  Eigen::VectorXd residualForce(const Eigen::VectorXd& state) const;

 private:
  std::vector<std::vector<int>> entries_;
  std::vector<double> stiffness_;                   ///< N/m, of each node's spring
  std::vector<Eigen::VectorXd> anchor_, accepted_;  ///< m, displacement of each spring's other end
};

}  // namespace microinjection
