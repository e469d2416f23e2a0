#pragma once

#include <Eigen/Core>

#include "cell/material/material.h"

namespace microinjection {

// Terms of second derivatives with respect to F, in the order of Material::Matrix9d.

/// A in the order of the rows of Material::Matrix9d.
inline Eigen::Map<const Eigen::Matrix<double, 9, 1>> flat(const Eigen::Matrix3d& A) {
  return Eigen::Map<const Eigen::Matrix<double, 9, 1>>(A.data());
}

/// result += weight C, C dF = (A : dF) A.
inline void addOuterProduct(double weight, const Eigen::Matrix3d& A, Material::Matrix9d& result) {
  result.noalias() += (weight * flat(A)).lazyProduct(flat(A).transpose());
}

/// result += weight C, C dF = A dF^T A.
inline void addTransposingProduct(double weight, const Eigen::Matrix3d& A, Material::Matrix9d& result) {
  const Eigen::Matrix3d B = weight * A;
  for (int J = 0; J < 3; ++J) {
    for (int L = 0; L < 3; ++L) {
      result.block<3, 3>(3 * J, 3 * L) += B.col(L).lazyProduct(A.col(J).transpose());
    }
  }
}

/// result += C, C dF = dF A, with a symmetric A.
inline void addRightProduct(const Eigen::Matrix3d& A, Material::Matrix9d& result) {
  for (int J = 0; J < 3; ++J) {
    for (int L = 0; L < 3; ++L) result.block<3, 3>(3 * J, 3 * L).diagonal().array() += A(J, L);
  }
}

/// result += C, C dF = A dF, with a symmetric A.
inline void addLeftProduct(const Eigen::Matrix3d& A, Material::Matrix9d& result) {
  for (int J = 0; J < 3; ++J) result.block<3, 3>(3 * J, 3 * J) += A;
}

}  // namespace microinjection
