#include "cell/material/material_models.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "cell/material/second_derivatives.h"
#include "cell/material/volume.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;

Eigen::Matrix3d smallStrain(const Eigen::Matrix3d& F) {
  return 0.5 * (F + F.transpose()) - Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d greenStrain(const Eigen::Matrix3d& F) {
  return 0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity());
}

/// The rotation R that maximises tr(R^T F), from the singular value decomposition. The smallest
/// singular value is taken negative when F is inverted.
Matrix3d rotationFromSingularValues(const Matrix3d& F) {
  const Eigen::JacobiSVD<Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

/// Same rotation by Newton's iteration for the polar decomposition (Higham 1986), which is several
/// times faster unless F is nearly singular or inverted.
Matrix3d nearestRotation(const Matrix3d& F) {
  Matrix3d X = F;
  for (int i = 0; i < 8; ++i) {
    const Matrix3d cofactor = cofactors(X);
    const double J = X.determinant();
    if (!(J > 1e-3)) break;
    const Matrix3d step = 0.5 * ((1 / J) * cofactor - X);
    X += step;
    if (step.squaredNorm() < 1e-17) return X;  // the error is about the square of the step
  }
  return rotationFromSingularValues(F);
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
  // dI1 = 2 F : dF, dI2 = 2 (I1 F - F C) : dF. Each gets its part of d(ln J) = F^-T : dF.
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

Corotated::Corotated(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

Material::Kinematics Corotated::kinematics(const Matrix3d& F) const {
  const Matrix3d R = nearestRotation(F);
  return {F, R.cwiseProduct(F).sum() - 3, R};
}

double Corotated::modelEnergy(const Kinematics& kinematics) const {
  return mu_ * (kinematics.deformation_gradient - kinematics.dilatation_gradient).squaredNorm();
}

Matrix3d Corotated::modelStress(const Kinematics& kinematics) const {
  return 2 * mu_ * (kinematics.deformation_gradient - kinematics.dilatation_gradient);
}

void Corotated::addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                                Matrix9d& result) const {
  // With S = R^T F: dR = R [w]x and (tr(S) I - S) w = axial(R^T dF - dF^T R). The eigenvalues of
  // the matrix are s_i + s_j, those of the twist modes of F.
  const Matrix3d& R = kinematics.dilatation_gradient;
  const Matrix3d S = R.transpose() * kinematics.deformation_gradient;
  Matrix3d twist = -0.5 * (S + S.transpose());
  twist.diagonal().array() += S.trace();
  const Matrix3d cofactor = cofactors(twist);
  // At a reflection (s_i + s_j = 0) R is not differentiable. The guard keeps the tangent finite.
  const double scale = std::max(twist.trace() / 3, 1e-6), guard = 1e-6 * scale * scale * scale;
  const double weight = (dilatation_weight - 2 * energy_weight * mu_) / std::max(twist.determinant(), guard);
  Eigen::Matrix<double, 3, 9> axial;
  axial << Eigen::RowVector3d::Zero(), R.col(2).transpose(), -R.col(1).transpose(),  //
      -R.col(2).transpose(), Eigen::RowVector3d::Zero(), R.col(0).transpose(),       //
      R.col(1).transpose(), -R.col(0).transpose(), Eigen::RowVector3d::Zero();
  const Eigen::Matrix<double, 3, 9> turn = weight * cofactor * axial;
  result.noalias() += axial.transpose().lazyProduct(turn);
  result.diagonal().array() += 2 * energy_weight * mu_;
}

}  // namespace microinjection
