#pragma once

#include "cell/material/lame.h"
#include "cell/material/material.h"

namespace microinjection {

/// Compressible Mooney-Rivlin: W = C10 (I1 - 3) + C01 (I2 - 3) - 2 (C10 + 2 C01) ln J + lambda'/2 g^2, g = ln J, with
/// I1 = tr C, I2 = ((tr C)^2 - tr C^2) / 2, C = F^T F, J = det F. C10 + C01 = mu/2 and lambda' = lambda - 4 C01 give
/// Hooke's law at small strain (I2 brings (ln J)^2 of its own). Infinite for J <= 0; where lambda' < 0, which is where
/// nu < ratio / (1 + 2 ratio), it softens under strong compression.
class MooneyRivlin : public Material {
 public:
  /// @param ratio C01 / (C10 + C01), in [0, 1]; 0 is neo-Hookean
  MooneyRivlin(const Lame& lame, double ratio);

  Kinematics kinematics(const Eigen::Matrix3d& F) const override;
  bool resistsInversion() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override;
  Eigen::Matrix3d modelStress(const Kinematics& kinematics) const override;
  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override;

 private:
  double c10_;  ///< Pa
  double c01_;  ///< Pa
};

}  // namespace microinjection
