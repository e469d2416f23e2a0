#include "cell/material/stable_neo_hookean.h"

#include <cmath>

#include "cell/material/second_derivatives.h"
#include "cell/material/volume.h"

namespace microinjection {

StableNeoHookean::StableNeoHookean(const Lame& lame)
    : Material(lame.lambda + 5.0 / 6 * lame.mu, lame), m_(4.0 / 3 * lame.mu) {}

Material::Kinematics StableNeoHookean::kinematics(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d cofactor = cofactors(F);
  return {F, F.determinant() - 1, cofactor};
}

double StableNeoHookean::modelEnergy(const Kinematics& kinematics) const {
  const double I = kinematics.deformation_gradient.squaredNorm();
  return m_ * (0.5 * (I - 3) - 0.5 * std::log((I + 1) / 4) - 0.75 * kinematics.dilatation);
}

Eigen::Matrix3d StableNeoHookean::modelStress(const Kinematics& kinematics) const {
  const double stretching = m_ * (1 - 1 / (kinematics.deformation_gradient.squaredNorm() + 1));
  return stretching * kinematics.deformation_gradient - 0.75 * m_ * kinematics.dilatation_gradient;
}

void StableNeoHookean::addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                                       Matrix9d& result) const {
  const Eigen::Matrix3d& F = kinematics.deformation_gradient;
  const double m = energy_weight * m_, inverse = 1 / (F.squaredNorm() + 1);
  addOuterProduct(2 * m * inverse * inverse, F, result);
  result.diagonal().array() += m * (1 - inverse);
  // The columns f of F have the cofactors f_K x f_L, hence d(cof F)_J = df_K x f_L + f_K x df_L.
  const double weight = dilatation_weight - 0.75 * m;
  for (int J = 0; J < 3; ++J) {
    const int K = (J + 1) % 3, L = (J + 2) % 3;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      result(i + 3 * J, j + 3 * K) += weight * F(k, L);
      result(i + 3 * J, k + 3 * K) -= weight * F(j, L);
      result(i + 3 * J, k + 3 * L) += weight * F(j, K);
      result(i + 3 * J, j + 3 * L) -= weight * F(k, K);
    }
  }
}

}  // namespace microinjection
