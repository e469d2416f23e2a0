#pragma once

#include "cell/material/lame.h"
#include "cell/material/material.h"

namespace microinjection {

/// Stable neo-Hookean (Smith, de Goes, Kim, "Stable neo-Hookean flesh simulation", ACM Transactions on Graphics 37,
/// 2018, equation 14): W = m/2 (I - 3) + l/2 (J - a)^2 - m/2 ln(I + 1) + constant, a = 1 + 3 m / (4 l), with
/// I = tr(F^T F), J = det F; m = 4/3 mu and l = lambda + 5/6 mu give Hooke's law at small strain. Here the square is
/// l/2 g^2, g = J - 1, and the rest of it -3/4 m (J - 1). Finite and smooth for every F, inverted ones too. That rest
/// loosens the volume: with Prony terms the undeformed state is stable while their ratios sum to less than 6 l / mu
/// - 1.
class StableNeoHookean : public Material {
 public:
  explicit StableNeoHookean(const Lame& lame);

  Kinematics kinematics(const Eigen::Matrix3d& F) const override;

 protected:
  double modelEnergy(const Kinematics& kinematics) const override;
  Eigen::Matrix3d modelStress(const Kinematics& kinematics) const override;
  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override;

 private:
  double m_;  ///< Pa
};

}  // namespace microinjection
