#include "cell/material/st_venant_kirchhoff.h"

#include "cell/material/second_derivatives.h"

namespace microinjection {
namespace {

Eigen::Matrix3d greenStrain(const Eigen::Matrix3d& F) {
  return 0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity());
}

}  // namespace

StVenantKirchhoff::StVenantKirchhoff(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

Material::Kinematics StVenantKirchhoff::kinematics(const Eigen::Matrix3d& F) const {
  return {F, 0.5 * (F.squaredNorm() - 3), F};
}

double StVenantKirchhoff::modelEnergy(const Kinematics& kinematics) const {
  return mu_ * greenStrain(kinematics.deformation_gradient).squaredNorm();
}

Eigen::Matrix3d StVenantKirchhoff::modelStress(const Kinematics& kinematics) const {
  return 2 * mu_ * kinematics.deformation_gradient * greenStrain(kinematics.deformation_gradient);
}

void StVenantKirchhoff::addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                                        Matrix9d& result) const {
  // P = F S with S = 2 mu E: dP = dF S + 2 mu F sym(F^T dF); and dg/dF = F.
  const Eigen::Matrix3d& F = kinematics.deformation_gradient;
  const double mu = energy_weight * mu_;
  Eigen::Matrix3d S = 2 * mu * greenStrain(F);
  S.diagonal().array() += dilatation_weight;
  addTransposingProduct(mu, F, result);
  addRightProduct(S, result);
  addLeftProduct(mu * F * F.transpose(), result);
}

}  // namespace microinjection
