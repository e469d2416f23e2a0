#include "material/neo_hookean.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

namespace microinjection {

NeoHookean::NeoHookean(const Lame& lame) : lame_(lame) {}

double NeoHookean::energyDensity(const Eigen::Matrix3d& F) const {
  const double J = F.determinant();
  if (!(J > 0)) return std::numeric_limits<double>::infinity();
  const double log_J = std::log(J);
  return 0.5 * lame_.mu * (F.squaredNorm() - 3) - lame_.mu * log_J + 0.5 * lame_.lambda * log_J * log_J;
}

Eigen::Matrix3d NeoHookean::stress(const Eigen::Matrix3d& F) const {
  const Eigen::Matrix3d F_inverse_transposed = F.inverse().transpose();
  return lame_.mu * F + (lame_.lambda * std::log(F.determinant()) - lame_.mu) * F_inverse_transposed;
}

Material::Matrix9d NeoHookean::tangent(const Eigen::Matrix3d& F) const {
  // d(F^-T) = -F^-T dF^T F^-T and d(ln J) = F^-T : dF.
  const Eigen::Matrix3d G = F.inverse().transpose();
  const Eigen::Map<const Eigen::Matrix<double, 9, 1>> g(G.data());
  const double factor = lame_.mu - lame_.lambda * std::log(F.determinant());
  Matrix9d result = lame_.lambda * g * g.transpose();
  result.diagonal().array() += lame_.mu;
  for (int J = 0; J < 3; ++J) {
    for (int L = 0; L < 3; ++L) {
      result.block<3, 3>(3 * J, 3 * L) += factor * G.col(L) * G.col(J).transpose();
    }
  }
  return result;
}

}  // namespace microinjection
