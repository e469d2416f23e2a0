#include "material/st_venant_kirchhoff.h"

namespace microinjection {
namespace {

Eigen::Matrix3d greenStrain(const Eigen::Matrix3d& F) {
  return 0.5 * (F.transpose() * F - Eigen::Matrix3d::Identity());
}

}  // namespace

StVenantKirchhoff::StVenantKirchhoff(const Lame& lame) : lame_(lame) {}

double StVenantKirchhoff::energyDensity(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d strain = greenStrain(F);
  const double trace = strain.trace();
  return lame_.mu * strain.squaredNorm() + 0.5 * lame_.lambda * trace * trace;
}

Eigen::Matrix3d StVenantKirchhoff::secondPiola(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d strain = greenStrain(F);
  return 2 * lame_.mu * strain + lame_.lambda * strain.trace() * Eigen::Matrix3d::Identity();
}

Eigen::Matrix3d StVenantKirchhoff::stress(const Eigen::Matrix3d& F) const { return F * secondPiola(F); }

Material::Matrix9d StVenantKirchhoff::tangent(const Eigen::Matrix3d& F) const {
  // dP = dF S + F dS with dS = 2 mu dE + lambda tr(dE) I and dE = sym(F^T dF).
  const Eigen::Matrix3d S = secondPiola(F);
  const Eigen::Matrix3d B = F * F.transpose();
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> f(F.data());
  Matrix9d result = lame_.lambda * f * f.transpose();
  for (int J = 0; J < 3; ++J) {
    for (int L = 0; L < 3; ++L) {
      result.block<3, 3>(3 * J, 3 * L) += lame_.mu * F.col(L) * F.col(J).transpose();
      result.block<3, 3>(3 * J, 3 * L).diagonal().array() += S(J, L);
    }
    result.block<3, 3>(3 * J, 3 * J) += lame_.mu * B;
  }
  return result;
}

}  // namespace microinjection
