#include "cell/material/mooney_rivlin.h"

#include "cell/material/second_derivatives.h"
#include "cell/material/volume.h"

namespace microinjection {

using Eigen::Matrix3d;

MooneyRivlin::MooneyRivlin(const Lame& lame, double ratio)
    : Material(lame.lambda - 2 * ratio * lame.mu, lame),
      c10_(0.5 * (1 - ratio) * lame.mu),
      c01_(0.5 * ratio * lame.mu) {}

Material::Kinematics MooneyRivlin::kinematics(const Matrix3d& F) const { return logarithmicDilatation(F); }

double MooneyRivlin::modelEnergy(const Kinematics& kinematics) const {
  const Matrix3d C = kinematics.deformation_gradient.transpose() * kinematics.deformation_gradient;
  const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - C.squaredNorm());
  return c10_ * (I1 - 3) + c01_ * (I2 - 3) - 2 * (c10_ + 2 * c01_) * kinematics.dilatation;
}

Matrix3d MooneyRivlin::modelStress(const Kinematics& kinematics) const {
  // dI1 = 2 F : dF, dI2 = 2 (I1 F - F C) : dF, and each takes its share of d(ln J) = F^-T : dF.
  const Matrix3d &F = kinematics.deformation_gradient, &F_inverse_transposed = kinematics.dilatation_gradient;
  Matrix3d S = -F.transpose() * F;
  S.diagonal().array() += F.squaredNorm();
  return 2 * c10_ * (F - F_inverse_transposed) + 2 * c01_ * (F * S - 2 * F_inverse_transposed);
}

void MooneyRivlin::addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                                   Matrix9d& result) const {
  // d(I1 F - F C) = 2 (F : dF) F + I1 dF - dF C - F dF^T F - F F^T dF, and as for neo-Hookean.
  const Matrix3d& F = kinematics.deformation_gradient;
  const double c10 = energy_weight * c10_, c01 = energy_weight * c01_;
  Matrix3d S = -2 * c01 * F.transpose() * F;
  S.diagonal().array() += 2 * (c10 + c01 * F.squaredNorm());
  addTransposingProduct(2 * (c10 + 2 * c01) - dilatation_weight, kinematics.dilatation_gradient, result);
  addTransposingProduct(-2 * c01, F, result);
  addOuterProduct(4 * c01, F, result);
  addRightProduct(S, result);
  addLeftProduct(-2 * c01 * F * F.transpose(), result);
}

}  // namespace microinjection
