#pragma once

#include "cell/material/lame.h"
#include "cell/material/material.h"

namespace microinjection {

/// Corotated linear elasticity: W = mu |F - R|^2 + lambda/2 g^2, g = tr(R^T F) - 3, with R the rotation nearest to F
/// (Sifakis and Barbic, "FEM simulation of 3D deformable solids", 3.4). R is in SO(3) also when F is inverted; there
/// it jumps where the two smaller singular values of F become equal (reflections), and W has a kink.
class Corotated : public Material {
 public:
  explicit Corotated(const Lame& lame);

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
