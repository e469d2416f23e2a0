#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/material/viscoelasticity.h"

namespace microinjection {

/// Viscoelastic memory of a force (quasi-linear viscoelasticity, Fung, "Biomechanics", 7.6): each
/// Prony term adds q to the elastic force F, dq/dt + q/tau = beta dF/dt, integrated exactly for an
/// F that changes linearly within the step. At small strain it is the force of a nearly
/// incompressible cell whose layers relax alike.
class ForceMemory {
 public:
  explicit ForceMemory(const std::vector<PronyTerm>& terms);

  /// Viscous force (N) that is added to `elastic` (N), `duration` (s, >= 0) after the last step.
  /// Does not allocate.
  Eigen::Vector3d step(const Eigen::Vector3d& elastic, double duration);
  void reset();
  bool isViscous() const { return !branches_.empty(); }

  /// Goes on from this elastic force (N), as if it had always been there, with this viscous one (N), of which each term
  /// has a part in proportion to its modulus.
  void start(const Eigen::Vector3d& elastic, const Eigen::Vector3d& viscous);
  Eigen::Vector3d viscous() const;  ///< N, of the last step

 private:
  struct Branch {
    PronyTerm term;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< N
  };
  std::vector<Branch> branches_;
  Eigen::Vector3d elastic_ = Eigen::Vector3d::Zero();  ///< N, of the last step
};

}  // namespace microinjection
