#include "cell/material/corotated.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

#include "cell/material/second_derivatives.h"
#include "cell/material/volume.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;

/// The rotation R that maximises tr(R^T F): from the singular value decomposition with the smallest singular value
/// taken negative when F is inverted.
Matrix3d rotationFromSingularValues(const Matrix3d& F) {
  const Eigen::JacobiSVD<Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

/// The same; by Newton's iteration for the polar decomposition (Higham 1986), several times faster, for ordinary F.
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
  // With S = R^T F: dR = R [w]x and (tr(S) I - S) w = axial(R^T dF - dF^T R). The eigenvalues of the matrix are s_i +
  // s_j: the twist modes of F.
  const Matrix3d& R = kinematics.dilatation_gradient;
  const Matrix3d S = R.transpose() * kinematics.deformation_gradient;
  Matrix3d twist = -0.5 * (S + S.transpose());
  twist.diagonal().array() += S.trace();
  const Matrix3d cofactor = cofactors(twist);
  // At a reflection, s_i + s_j = 0, R is not differentiable: the guard keeps the tangent finite.
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
