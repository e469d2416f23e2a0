#include "cell/material/linear_material.h"

namespace microinjection {
namespace {

Eigen::Matrix3d smallStrain(const Eigen::Matrix3d& F) {
  return 0.5 * (F + F.transpose()) - Eigen::Matrix3d::Identity();
}

}  // namespace

LinearMaterial::LinearMaterial(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

Material::Kinematics LinearMaterial::kinematics(const Eigen::Matrix3d& F) const {
  return {F, F.trace() - 3, Eigen::Matrix3d::Identity()};
}

double LinearMaterial::modelEnergy(const Kinematics& kinematics) const {
  return mu_ * smallStrain(kinematics.deformation_gradient).squaredNorm();
}

Eigen::Matrix3d LinearMaterial::modelStress(const Kinematics& kinematics) const {
  return 2 * mu_ * smallStrain(kinematics.deformation_gradient);
}

void LinearMaterial::addModelTangent(const Kinematics&, double energy_weight, double, Matrix9d& result) const {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(i + 3 * j, i + 3 * j) += energy_weight * mu_;
      result(i + 3 * j, j + 3 * i) += energy_weight * mu_;
    }
  }
}

}  // namespace microinjection
