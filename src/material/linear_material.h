#pragma once

#include "material/lame.h"
#include "material/material.h"

namespace microinjection {

/// Small-strain isotropic elasticity: with e = sym(F) - I, W = mu e:e + lambda/2 (tr e)^2.
class LinearMaterial : public Material {
 public:
  explicit LinearMaterial(const Lame& lame);

  double energyDensity(const Eigen::Matrix3d& F) const override;
  Eigen::Matrix3d stress(const Eigen::Matrix3d& F) const override;
  Matrix9d tangent(const Eigen::Matrix3d& F) const override;
  bool isLinear() const override { return true; }

 private:
  Lame lame_;
};

}  // namespace microinjection
