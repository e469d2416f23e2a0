#pragma once

#include "cell/material/lame.h"
#include "cell/material/material.h"

namespace microinjection {

/// Small-strain isotropic elasticity: with e = sym(F) - I, W = mu e:e + lambda/2 g^2, g = tr e.
class LinearMaterial : public Material {
 public:
  explicit LinearMaterial(const Lame& lame);

  Kinematics kinematics(const Eigen::Matrix3d& F) const override;
  bool isLinear() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override;
  Eigen::Matrix3d modelStress(const Kinematics& kinematics) const override;
  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override;

 private:
  double mu_;  ///< Pa
};

}  // namespace microinjection
