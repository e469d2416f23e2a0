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
/// Cells are nearly incompressible (Poisson's ratio 0.49 in the paper's Table I), and elements without a pressure lock
/// there: the force of P1 tetrahedra is 76 % too large, that of P2 triangles in the section 3.5 % (neo-Hookean, 5 um:
/// doc/reference/benchmarks.md, Elements). So every material has to offer its volumetric energy apart. Each model takes
/// its own dilatation g (tr e, tr E, ln J, J - 1, ...) rather than the usual split into J and J^(-1/3) F, because that
/// split would turn the linear and the St-Venant-Kirchhoff law, which is the paper's, into other materials.
///
/// Strain and stress are those of space in every element: a section has F in the directions (r, theta, z), so that a
/// material is written once. The scene chooses it by name for each layer, hence a virtual interface.
/// material_models.cpp has the models with their sources, doc/maintain/material.md the way to a new one.
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
  /// is not defined (det F <= 0 if the material resists inversion, a stretch beyond the limit of gent).
  double energyDensity(const Eigen::Matrix3d& F) const { return energyDensity(kinematics(F), whole()); }
  /// First Piola-Kirchhoff stress P = dW/dF, Pa.
  Eigen::Matrix3d stress(const Eigen::Matrix3d& F) const { return stress(kinematics(F), whole()); }
  /// dP/dF, Pa.
  Matrix9d tangent(const Eigen::Matrix3d& F) const { return tangent(kinematics(F), whole()); }

  /// Second derivative of Wd, Pa. Wd is zero in the undeformed state and +infinity where W is.
  Matrix9d distortionalTangent(const Eigen::Matrix3d& F) const { return tangent(kinematics(F), distortional()); }

  /// g, zero in the undeformed state; dg/dF is the identity there.
  double dilatation(const Eigen::Matrix3d& F) const { return kinematics(F).dilatation; }

  /// kappa, Pa, > 0: the model's lambda or, where that is small or negative, the smaller one of mu and half of the bulk
  /// modulus. Wd contains (lambda - kappa)/2 g^2, so a kappa above the bulk modulus leaves a Wd that gives way to
  /// changes of volume. Of the models only stable_neo_hookean has that, by mu/6, because its lambda is Hooke's plus
  /// 5/6 mu.
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
  /// W - lambda/2 g^2, the part that relaxes in viscoelasticity. It differs from Wd if kappa exceeds the model's
  /// lambda: Wd then contains a negative multiple of g^2, which makes it negative under a strong compression, and which
  /// a Prony term would multiply.
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

/// Material model, its two long-term elastic constants, and its viscoelasticity. Every model is given by Hooke's
/// constants at small strain, whatever its own are, so that a scene can change its model and keep its stiffness at the
/// touch. The defaults are the paper's mouse oocyte (Table I).
struct MaterialConfig {
  std::string model = "neo_hookean";  ///< one of materialModels()
  double young_modulus = 17.9e3;      ///< Pa, > 0
  double poisson_ratio = 0.49;        ///< in (-1, 0.5)
  double mooney_ratio = 0.25;         ///< C01 / (C10 + C01) of mooney_rivlin, in [0, 1]; others ignore it
  double ogden_exponent = 4;          ///< alpha of ogden, in [1, 30]; 2 is neo-Hookean; others ignore it
  double gent_limit = 30;             ///< Jm of gent, of I1 - 3, in [0.1, 1e4]; others ignore it
  ViscoelasticityConfig viscoelasticity = {};

  /// Throws ConfigError with all errors at once.
  void validate() const;
};

/// linear, st_venant_kirchhoff, neo_hookean, mooney_rivlin, ogden, gent, stable_neo_hookean, corotated.
const std::vector<std::string>& materialModels();

/// Throws ConfigError when the configuration is not valid.
std::unique_ptr<Material> makeMaterial(const MaterialConfig& config);

}  // namespace microinjection
