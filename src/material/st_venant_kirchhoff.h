#pragma once

#include "material/lame.h"
#include "material/material.h"

namespace microinjection {

/// St-Venant-Kirchhoff: W = mu E:E + lambda/2 (tr E)^2 with the Green-Lagrange strain E = (F^T F - I) / 2; equation (1)
/// of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling for assisted biological cell injection".
/// It softens in compression, so equilibria are lost under a sharp tip at moderate depth.
class StVenantKirchhoff : public Material {
 public:
  explicit StVenantKirchhoff(const Lame& lame);

  double energyDensity(const Eigen::Matrix3d& F) const override;
  Eigen::Matrix3d stress(const Eigen::Matrix3d& F) const override;
  Matrix9d tangent(const Eigen::Matrix3d& F) const override;

 private:
  Eigen::Matrix3d secondPiola(const Eigen::Matrix3d& F) const;

  Lame lame_;
};

}  // namespace microinjection
