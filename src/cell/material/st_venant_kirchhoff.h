#pragma once

#include "cell/material/lame.h"
#include "cell/material/material.h"

namespace microinjection {

/// St-Venant-Kirchhoff: W = mu E:E + lambda/2 g^2, g = tr E, with the Green-Lagrange strain E = (F^T F - I) / 2;
/// equation (1) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for assisted biological cell
/// injection". It softens in compression, so equilibria are lost under a sharp tip at moderate depth.
class StVenantKirchhoff : public Material {
 public:
  explicit StVenantKirchhoff(const Lame& lame);

  Kinematics kinematics(const Eigen::Matrix3d& F) const override;

 protected:
  double modelEnergy(const Kinematics& kinematics) const override;
  Eigen::Matrix3d modelStress(const Kinematics& kinematics) const override;
  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override;

 private:
  double mu_;  ///< Pa
};

}  // namespace microinjection
