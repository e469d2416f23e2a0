#include "material/linear_material.h"

namespace microinjection {
namespace {

Eigen::Matrix3d smallStrain(const Eigen::Matrix3d& F) {
  return 0.5 * (F + F.transpose()) - Eigen::Matrix3d::Identity();
}

}  // namespace

LinearMaterial::LinearMaterial(const Lame& lame) : lame_(lame) {}

double LinearMaterial::energyDensity(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d strain = smallStrain(F);
  const double trace = strain.trace();
  return lame_.mu * strain.squaredNorm() + 0.5 * lame_.lambda * trace * trace;
}

Eigen::Matrix3d LinearMaterial::stress(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d strain = smallStrain(F);
  return 2 * lame_.mu * strain + lame_.lambda * strain.trace() * Eigen::Matrix3d::Identity();
}

Material::Matrix9d LinearMaterial::tangent(const Eigen::Matrix3d&) const {
  Matrix9d result = Matrix9d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(i + 3 * j, i + 3 * j) += lame_.mu;
      result(i + 3 * j, j + 3 * i) += lame_.mu;
      result(i + 3 * i, j + 3 * j) += lame_.lambda;
    }
  }
  return result;
}

}  // namespace microinjection
