#include "cell/material/neo_hookean.h"

#include "cell/material/second_derivatives.h"
#include "cell/material/volume.h"

namespace microinjection {

NeoHookean::NeoHookean(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

Material::Kinematics NeoHookean::kinematics(const Eigen::Matrix3d& F) const { return logarithmicDilatation(F); }

double NeoHookean::modelEnergy(const Kinematics& kinematics) const {
  return 0.5 * mu_ * (kinematics.deformation_gradient.squaredNorm() - 3) - mu_ * kinematics.dilatation;
}

Eigen::Matrix3d NeoHookean::modelStress(const Kinematics& kinematics) const {
  return mu_ * (kinematics.deformation_gradient - kinematics.dilatation_gradient);
}

void NeoHookean::addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                                 Matrix9d& result) const {
  // d(F^-T) = -F^-T dF^T F^-T.
  const double mu = energy_weight * mu_;
  addTransposingProduct(mu - dilatation_weight, kinematics.dilatation_gradient, result);
  result.diagonal().array() += mu;
}

}  // namespace microinjection
