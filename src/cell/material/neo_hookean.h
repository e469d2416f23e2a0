#pragma once

#include "cell/material/lame.h"
#include "cell/material/material.h"

namespace microinjection {

/// Compressible neo-Hookean: W = mu/2 (I1 - 3) - mu ln J + lambda/2 g^2, g = ln J, with I1 = tr(F^T F), J = det F
/// (Bonet and Wood, "Nonlinear continuum mechanics for finite element analysis", 6.4.3). Infinite for J <= 0; where
/// lambda < 0 it softens as J falls below exp(mu / lambda).
class NeoHookean : public Material {
 public:
  explicit NeoHookean(const Lame& lame);

  Kinematics kinematics(const Eigen::Matrix3d& F) const override;
  bool resistsInversion() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override;
  Eigen::Matrix3d modelStress(const Kinematics& kinematics) const override;
  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override;

 private:
  double mu_;  ///< Pa
};

}  // namespace microinjection
