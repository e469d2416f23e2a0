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

/// St-Venant-Kirchhoff: W = mu E:E + lambda/2 g^2, g = tr E, with the Green-Lagrange strain E =
/// (F^T F - I) / 2; equation (1) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling
/// for assisted biological cell injection". It softens in compression, so that no equilibrium
/// exists under a sharp tip beyond a moderate depth.
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

/// Compressible neo-Hookean: W = mu/2 (I1 - 3) - mu ln J + lambda/2 g^2, g = ln J, with I1 = tr(F^T
/// F), J = det F (Bonet and Wood, "Nonlinear continuum mechanics for finite element analysis",
/// 6.4.3). Infinite for J <= 0. With lambda < 0 it softens for J below exp(mu / lambda).
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

/// Compressible Mooney-Rivlin: W = C10 (I1 - 3) + C01 (I2 - 3) - 2 (C10 + 2 C01) ln J + lambda'/2
/// g^2, g = ln J, with I1 = tr C, I2 = ((tr C)^2 - tr C^2) / 2, C = F^T F, J = det F. C10 + C01 =
/// mu/2 and lambda' = lambda - 4 C01 give Hooke's law at small strain, because I2 contributes a
/// term in (ln J)^2. Infinite for J <= 0. With lambda' < 0, that is nu < ratio / (1 + 2 ratio), it
/// softens under strong compression.
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

/// Stable neo-Hookean (Smith, de Goes, Kim, "Stable neo-Hookean flesh simulation", ACM Transactions
/// on Graphics 37, 2018, equation 14): W = m/2 (I - 3) + l/2 (J - a)^2 - m/2 ln(I + 1) + constant,
/// a = 1 + 3 m / (4 l), with I = tr(F^T F), J = det F; m = 4/3 mu and l = lambda + 5/6 mu give
/// Hooke's law at small strain. Here the square is l/2 g^2, g = J - 1, and its remainder -3/4 m (J
/// - 1). Finite and smooth for every F, also inverted. The remainder weakens the volumetric
/// stiffness: with Prony terms the undeformed state is stable while their ratios sum to less than 6
/// l / mu - 1.
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

/// Corotated linear elasticity: W = mu |F - R|^2 + lambda/2 g^2, g = tr(R^T F) - 3, with R the
/// rotation nearest to F (Sifakis and Barbic, "FEM simulation of 3D deformable solids", 3.4). R is
/// in SO(3) also when F is inverted. It jumps there when the two smaller singular values of F
/// become equal (reflections), and W has a kink.
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
