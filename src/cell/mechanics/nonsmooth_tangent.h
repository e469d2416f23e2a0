#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "cell/mechanics/energy_term.h"

namespace microinjection {

/// Tangent of the elements that are not smooth (EnergyTerm::isNonsmooth), in the few unknowns that
/// they depend on. With it a factorisation follows the contact at a small part of its cost.
class NonsmoothTangent {
 public:
  /// @param unknown of each entry of the state; those below 0 or not below `size` have no tangent here
  NonsmoothTangent(const std::vector<std::shared_ptr<EnergyTerm>>& terms, const std::vector<int>& unknown, int size);

  /// Its unknowns, in the order of the tangent's rows; empty when there is none.
  const std::vector<int>& unknowns() const { return unknowns_; }

  /// Sum over the elements, N/m. False when smooth elements of their terms contribute, too, or the
  /// state is not admissible.
  bool evaluate(const Eigen::VectorXd& state, Eigen::MatrixXd& tangent);

 private:
  std::vector<std::shared_ptr<EnergyTerm>> terms_;  ///< those with an element that is not smooth
  std::vector<int> rows_;                           ///< of each entry of the state; -1: none
  std::vector<int> unknowns_;
  LocalEnergy local_;
};

}  // namespace microinjection
