#include "cell/material/viscoelastic_step.h"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <string>

#include "cell/material/second_derivatives.h"

namespace microinjection {

using Eigen::Matrix3d;

ViscoelasticMemory::ViscoelasticMemory(const ViscoelasticityConfig& config)
    : metric(Matrix3d::Identity()),
      relaxing_stress(Matrix3d::Zero()),
      branch_stresses(config.prony.size(), Matrix3d::Zero()) {}

ViscoelasticStep::ViscoelasticStep(const Material& material, const ViscoelasticityConfig& config, double dt)
    : material_(material), viscosity_rate_(config.viscosity / dt) {
  if (!(dt > 0)) throw std::invalid_argument("time step = " + std::to_string(dt) + " s: must be > 0");
  for (const PronyTerm& term : config.prony) {
    const double x = dt / term.relaxation_time;
    branches_.push_back({std::exp(-x), term.modulus_ratio * (x > 0 ? -std::expm1(-x) / x : 1)});
    gain_ += branches_.back().gain;
  }
}

double ViscoelasticStep::energy(const ViscoelasticMemory& memory, const Material::Kinematics& kinematics) const {
  const Matrix3d C = metric(kinematics.deformation_gradient);
  return material_.energyDensity(kinematics, relaxing()) +
         0.5 * history(memory).cwiseProduct(C - Matrix3d::Identity()).sum() +
         0.25 * viscosity_rate_ * (C - memory.metric).squaredNorm();
}

Matrix3d ViscoelasticStep::stress(const ViscoelasticMemory& memory, const Material::Kinematics& kinematics) const {
  const Matrix3d S = history(memory) + viscosity_rate_ * (metric(kinematics.deformation_gradient) - memory.metric);
  const Matrix3d relaxing_stress = material_.stress(kinematics, relaxing());
  return material_.isLinear() ? Matrix3d(relaxing_stress + S)
                              : Matrix3d(relaxing_stress + kinematics.deformation_gradient * S);
}

Material::Matrix9d ViscoelasticStep::tangent(const ViscoelasticMemory& memory,
                                             const Material::Kinematics& kinematics) const {
  Material::Matrix9d result = material_.tangent(kinematics, relaxing());
  // d(F S) = dF S + F dS, dS = eta/dt (dF^T F + F^T dF); without the factor F if the material is
  // linear.
  const Matrix3d F = material_.isLinear() ? Matrix3d::Identity() : kinematics.deformation_gradient;
  addTransposingProduct(viscosity_rate_, F, result);
  addLeftProduct(viscosity_rate_ * F * F.transpose(), result);
  if (material_.isLinear()) return result;
  addRightProduct(history(memory) + viscosity_rate_ * (metric(F) - memory.metric), result);
  return result;
}

void ViscoelasticStep::accept(const Material::Kinematics& kinematics, ViscoelasticMemory& memory) const {
  Matrix3d S = material_.stress(kinematics, material_.relaxing());
  if (!material_.isLinear()) S = kinematics.deformation_gradient.inverse() * S;
  S = (0.5 * (S + S.transpose())).eval();  // H must be symmetric, or stress() is not the derivative of energy()
  for (size_t i = 0; i < branches_.size(); ++i) {
    Matrix3d& Q = memory.branch_stresses[i];
    Q = branches_[i].decay * Q + branches_[i].gain * (S - memory.relaxing_stress);
  }
  memory.relaxing_stress = S;
  memory.metric = metric(kinematics.deformation_gradient);
}

Material::Weights ViscoelasticStep::relaxing() const {
  const Material::Weights weights = material_.relaxing();
  return {gain_ * weights.distortional, gain_ * weights.pressure, gain_ * weights.modulus};
}

/// C, or I + 2 e of a linear material. In both cases 1/2 S : dC is the work.
Matrix3d ViscoelasticStep::metric(const Matrix3d& F) const {
  if (material_.isLinear()) return F + F.transpose() - Matrix3d::Identity();
  return F.transpose() * F;
}

Matrix3d ViscoelasticStep::history(const ViscoelasticMemory& memory) const {
  Matrix3d H = -gain_ * memory.relaxing_stress;
  for (size_t i = 0; i < branches_.size(); ++i) H += branches_[i].decay * memory.branch_stresses[i];
  return H;
}

}  // namespace microinjection
