#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "cell/material/material.h"

namespace microinjection {

/// Cofactors of F, det F F^-T. The columns are cross products of those of F, so that they exist for
/// any F.
inline Eigen::Matrix3d cofactors(const Eigen::Matrix3d& F) {
  Eigen::Matrix3d result;
  result.col(0) = F.col(1).cross(F.col(2));
  result.col(1) = F.col(2).cross(F.col(0));
  result.col(2) = F.col(0).cross(F.col(1));
  return result;
}

/// a x b = cross(a) b.
inline Eigen::Matrix3d cross(const Eigen::Vector3d& a) {
  Eigen::Matrix3d result;
  result << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return result;
}

/// Kinematics of a material with the dilatation g = ln det F, hence dg/dF = F^-T.
inline Material::Kinematics logarithmicDilatation(const Eigen::Matrix3d& F) {
  const Eigen::Matrix3d cofactor = cofactors(F);
  const double J = F.determinant();
  return {F, J > 0 ? std::log(J) : -std::numeric_limits<double>::infinity(), (1 / J) * cofactor};
}

}  // namespace microinjection
