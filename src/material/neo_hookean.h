#pragma once

#include "material/lame.h"
#include "material/material.h"

namespace microinjection {

/// Compressible neo-Hookean: W = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2, with I1 = tr(F^T F), J = det F
/// (Bonet and Wood, "Nonlinear continuum mechanics for finite element analysis", 6.4.3). Infinite for J <= 0.
class NeoHookean : public Material {
 public:
  explicit NeoHookean(const Lame& lame);

  double energyDensity(const Eigen::Matrix3d& F) const override;
  Eigen::Matrix3d stress(const Eigen::Matrix3d& F) const override;
  Matrix9d tangent(const Eigen::Matrix3d& F) const override;

 private:
  Lame lame_;
};

}  // namespace microinjection
