#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "cell/material/lame.h"
#include "cell/material/viscoelasticity.h"

namespace microinjection {

/// Hyperelastic material: all results are functions of the deformation gradient F = dx/dX. Its
/// energy has two parts,
///
///     W = Wd + kappa/2 g^2,
///
/// the distortional part Wd and a penalty on the dilatation g. An element with its own pressure p
/// uses p g - p^2 / (2 kappa) instead of the penalty, which is the same for p = kappa g. Wd is the
/// rest of the model's energy and also depends on volume changes.
///
/// Matrices of 9 x 9: row and column i + 3 J stand for component (i, J), the column-major order of
/// Eigen; symmetric. Stresses and tangents: @pre energyDensity(F) is finite.
///
/// Each function of F computes kinematics(F) first. To evaluate several at one F, compute it once
/// and call the functions of Kinematics.
class Material {
 public:
  using Matrix9d = Eigen::Matrix<double, 9, 9>;

  /// Quantities that a material derives from F first.
  struct Kinematics {
    Eigen::Matrix3d deformation_gradient;  ///< F
    double dilatation;                     ///< g(F); -infinity for det F <= 0 if the material resists inversion
    Eigen::Matrix3d dilatation_gradient;   ///< dg/dF; the identity in the undeformed state
  };

  /// Weights, independent of F, of the sum distortional Wd + pressure g + modulus/2 g^2.
  struct Weights {
    double distortional;
    double pressure;  ///< Pa
    double modulus;   ///< Pa
  };

  virtual ~Material() = default;

  virtual Kinematics kinematics(const Eigen::Matrix3d& F) const = 0;

  /// Strain energy W per undeformed volume, J/m^3; zero in the undeformed state, +infinity where it
  /// is not defined (det F <= 0 if the material resists inversion).
  double energyDensity(const Eigen::Matrix3d& F) const { return energyDensity(kinematics(F), whole()); }
  /// First Piola-Kirchhoff stress P = dW/dF, Pa.
  Eigen::Matrix3d stress(const Eigen::Matrix3d& F) const { return stress(kinematics(F), whole()); }
  /// dP/dF, Pa.
  Matrix9d tangent(const Eigen::Matrix3d& F) const { return tangent(kinematics(F), whole()); }

  /// Second derivative of Wd, Pa. Wd is zero in the undeformed state and +infinity where W is.
  Matrix9d distortionalTangent(const Eigen::Matrix3d& F) const { return tangent(kinematics(F), distortional()); }

  /// g, zero in the undeformed state; dg/dF is the identity there.
  double dilatation(const Eigen::Matrix3d& F) const { return kinematics(F).dilatation; }

  /// kappa, Pa, > 0: the model's lambda, or more when lambda is small or negative. It is at most
  /// the model's bulk modulus, so that Wd, which contains (lambda - kappa)/2 g^2, stays stable.
  double dilatationalModulus() const { return kappa_; }

  /// The weighted sum of the parts, J/m^3, with its first and second derivative, Pa.
  double energyDensity(const Kinematics& kinematics, const Weights& weights) const;
  Eigen::Matrix3d stress(const Kinematics& kinematics, const Weights& weights) const;
  Matrix9d tangent(const Kinematics& kinematics, const Weights& weights) const;

  Weights whole() const { return {1, 0, kappa_}; }     ///< W
  static Weights distortional() { return {1, 0, 0}; }  ///< Wd
  /// distortional Wd + p g at a fixed pressure p (Pa): mixed elements differentiate it with respect
  /// to F.
  static Weights mixed(double distortional, double pressure) { return {distortional, pressure, 0}; }
  /// W - lambda/2 g^2, the part that relaxes in viscoelasticity. It differs from Wd if kappa
  /// exceeds the model's lambda: Wd is then negative in a change of volume.
  Weights relaxing() const { return {1, 0, -lambda_excess_}; }

  /// The stress is a linear function of the displacement gradient: small strain, one solution at
  /// any load. det F has no meaning then.
  virtual bool isLinear() const { return false; }
  /// The energy is infinite for det F <= 0.
  virtual bool resistsInversion() const { return false; }

 protected:
  /// A model's W is modelEnergy + lambda/2 g^2. @param lambda of the model; it may differ from
  /// Hooke's, which is in `lame`
  Material(double lambda, const Lame& lame);

  virtual double modelEnergy(const Kinematics& kinematics) const = 0;
  virtual Eigen::Matrix3d modelStress(const Kinematics& kinematics) const = 0;
  /// result += second derivative of energy_weight modelEnergy + dilatation_weight g.
  virtual void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                               Matrix9d& result) const = 0;

 private:
  double kappa_;          ///< Pa
  double lambda_excess_;  ///< Pa, lambda - kappa, <= 0; 0 for nearly incompressible materials
};

/// Material model, its two long-term elastic constants, and its viscoelasticity.
struct MaterialConfig {
  std::string model = "neo_hookean";  ///< one of materialModels()
  double young_modulus = 17.9e3;      ///< Pa, > 0
  double poisson_ratio = 0.49;        ///< in (-1, 0.5)
  double mooney_ratio = 0.25;         ///< C01 / (C10 + C01) of mooney_rivlin, in [0, 1]; others ignore it
  ViscoelasticityConfig viscoelasticity = {};

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// linear, st_venant_kirchhoff, neo_hookean, mooney_rivlin, stable_neo_hookean, corotated.
const std::vector<std::string>& materialModels();

/// Throws ConfigError when the configuration is not valid.
std::unique_ptr<Material> makeMaterial(const MaterialConfig& config);

}  // namespace microinjection
