#pragma once

#include <Eigen/Core>
#include <vector>

#include "cell/material/material.h"
#include "cell/material/viscoelasticity.h"

namespace microinjection {

/// State of a viscoelastic material at one quadrature point after the last accepted step; initially
/// undeformed and at rest. S is the second Piola-Kirchhoff stress and C = F^T F. For a linear
/// material P and I + 2 e replace them.
struct ViscoelasticMemory {
  explicit ViscoelasticMemory(const ViscoelasticityConfig& config);

  Eigen::Matrix3d metric;                        ///< C
  Eigen::Matrix3d relaxing_stress;               ///< S of Material::relaxing(), Pa
  std::vector<Eigen::Matrix3d> branch_stresses;  ///< Q, Pa, one per Prony term
};

/// One time step of a viscoelastic material, from n to n + 1 (Simo and Hughes, "Computational
/// inelasticity", 10.2-10.3). Each Prony term adds Q to S, dQ/dt + Q/tau = beta dS/dt, integrated
/// exactly for an S that changes linearly within the step: with x = dt/tau and b = beta (1 -
/// exp(-x))/x, Q = exp(-x) Q_n + b (S - S_n). The viscosity adds eta (C - C_n)/dt, at small strain
/// 2 eta de/dt. The incremental potential of both is
///
///     V(F) = sum b W_r(F) + 1/2 H : (C - I) + eta/(4 dt) |C - C_n|^2, H = sum exp(-x) Q_n - b S_n,
///
/// with the relaxing part W_r of the material's energy. An element adds V and its derivatives to
/// the elastic ones. @pre a memory is made from the same configuration; F is not singular when a
/// nonlinear material is accepted, because S has no limit at det F = 0.
class ViscoelasticStep {
 public:
  /// @param dt length of the step, s, > 0 (else std::invalid_argument); infinity: everything has
  ///   relaxed and V is 0. `material` must outlive the step.
  ViscoelasticStep(const Material& material, const ViscoelasticityConfig& config, double dt);

  /// V up to a constant, J/m^3; its first and second derivative with respect to F, Pa, laid out as
  /// in Material.
  double energy(const ViscoelasticMemory& memory, const Material::Kinematics& kinematics) const;
  Eigen::Matrix3d stress(const ViscoelasticMemory& memory, const Material::Kinematics& kinematics) const;
  Material::Matrix9d tangent(const ViscoelasticMemory& memory, const Material::Kinematics& kinematics) const;

  /// Ends the step at this F: updates the memory to n + 1.
  void accept(const Material::Kinematics& kinematics, ViscoelasticMemory& memory) const;

 private:
  struct Branch {
    double decay;  ///< exp(-x)
    double gain;   ///< b
  };

  Material::Weights relaxing() const;
  Eigen::Matrix3d metric(const Eigen::Matrix3d& F) const;
  Eigen::Matrix3d history(const ViscoelasticMemory& memory) const;

  const Material& material_;
  std::vector<Branch> branches_;
  double gain_ = 0;        ///< sum of b
  double viscosity_rate_;  ///< eta/dt, Pa
};

}  // namespace microinjection
