#include "cell/material/material_models.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "cell/material/second_derivatives.h"
#include "cell/material/volume.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;

Matrix3d smallStrain(const Matrix3d& F) { return 0.5 * (F + F.transpose()) - Matrix3d::Identity(); }

Matrix3d greenStrain(const Matrix3d& F) { return 0.5 * (F.transpose() * F - Matrix3d::Identity()); }

/// The rotation R that maximises tr(R^T F), from the singular value decomposition. The smallest
/// singular value is taken negative when F is inverted.
Matrix3d rotationFromSingularValues(const Matrix3d& F) {
  const Eigen::JacobiSVD<Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d U = svd.matrixU();
  if ((U * svd.matrixV().transpose()).determinant() < 0) U.col(2) = -U.col(2);
  return U * svd.matrixV().transpose();
}

/// Same rotation by Newton's iteration for the polar decomposition (Higham 1986), which is several
/// times faster unless F is nearly singular or inverted.
Matrix3d nearestRotation(const Matrix3d& F) {
  Matrix3d X = F;
  for (int i = 0; i < 8; ++i) {
    const Matrix3d cofactor = cofactors(X);
    const double J = X.determinant();
    if (!(J > 1e-3)) break;
    const Matrix3d step = 0.5 * ((1 / J) * cofactor - X);
    X += step;
    if (step.squaredNorm() < 1e-17) return X;  // the error is about the square of the step
  }
  return rotationFromSingularValues(F);
}

/// Small-strain isotropic elasticity: with e = sym(F) - I, W = mu e:e + lambda/2 g^2, g = tr e.
class LinearMaterial : public Material {
 public:
  explicit LinearMaterial(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

  Kinematics kinematics(const Matrix3d& F) const override { return {F, F.trace() - 3, Matrix3d::Identity()}; }
  bool isLinear() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    return mu_ * smallStrain(kinematics.deformation_gradient).squaredNorm();
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    return 2 * mu_ * smallStrain(kinematics.deformation_gradient);
  }

  void addModelTangent(const Kinematics&, double energy_weight, double, Matrix9d& result) const override {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        result(i + 3 * j, i + 3 * j) += energy_weight * mu_;
        result(i + 3 * j, j + 3 * i) += energy_weight * mu_;
      }
    }
  }

 private:
  double mu_;  ///< Pa
};

/// St-Venant-Kirchhoff: W = mu E:E + lambda/2 g^2, g = tr E, with the Green-Lagrange strain E =
/// (F^T F - I) / 2; equation (1) of Ladjal, Hanus, Ferreira, "Micro-to-nano biomechanical modeling
/// for assisted biological cell injection". It softens in compression, so that no equilibrium
/// exists under a sharp tip beyond a moderate depth.
class StVenantKirchhoff : public Material {
 public:
  explicit StVenantKirchhoff(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

  Kinematics kinematics(const Matrix3d& F) const override { return {F, 0.5 * (F.squaredNorm() - 3), F}; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    return mu_ * greenStrain(kinematics.deformation_gradient).squaredNorm();
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    return 2 * mu_ * kinematics.deformation_gradient * greenStrain(kinematics.deformation_gradient);
  }

  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override {
    // P = F S with S = 2 mu E: dP = dF S + 2 mu F sym(F^T dF); and dg/dF = F.
    const Matrix3d& F = kinematics.deformation_gradient;
    const double mu = energy_weight * mu_;
    Matrix3d S = 2 * mu * greenStrain(F);
    S.diagonal().array() += dilatation_weight;
    addTransposingProduct(mu, F, result);
    addRightProduct(S, result);
    addLeftProduct(mu * F * F.transpose(), result);
  }

 private:
  double mu_;  ///< Pa
};

/// Compressible neo-Hookean: W = mu/2 (I1 - 3) - mu ln J + lambda/2 g^2, g = ln J, with I1 = tr(F^T
/// F), J = det F (Bonet and Wood, "Nonlinear continuum mechanics for finite element analysis",
/// 6.4.3). Infinite for J <= 0. With lambda < 0 it softens for J below exp(mu / lambda).
class NeoHookean : public Material {
 public:
  explicit NeoHookean(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

  Kinematics kinematics(const Matrix3d& F) const override { return logarithmicDilatation(F); }
  bool resistsInversion() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    return 0.5 * mu_ * (kinematics.deformation_gradient.squaredNorm() - 3) - mu_ * kinematics.dilatation;
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    return mu_ * (kinematics.deformation_gradient - kinematics.dilatation_gradient);
  }

  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override {
    // d(F^-T) = -F^-T dF^T F^-T.
    const double mu = energy_weight * mu_;
    addTransposingProduct(mu - dilatation_weight, kinematics.dilatation_gradient, result);
    result.diagonal().array() += mu;
  }

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
  MooneyRivlin(const Lame& lame, double ratio)
      : Material(lame.lambda - 2 * ratio * lame.mu, lame),
        c10_(0.5 * (1 - ratio) * lame.mu),
        c01_(0.5 * ratio * lame.mu) {}

  Kinematics kinematics(const Matrix3d& F) const override { return logarithmicDilatation(F); }
  bool resistsInversion() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    const Matrix3d C = kinematics.deformation_gradient.transpose() * kinematics.deformation_gradient;
    const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - C.squaredNorm());
    return c10_ * (I1 - 3) + c01_ * (I2 - 3) - 2 * (c10_ + 2 * c01_) * kinematics.dilatation;
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    // dI1 = 2 F : dF, dI2 = 2 (I1 F - F C) : dF. Each gets its part of d(ln J) = F^-T : dF.
    const Matrix3d &F = kinematics.deformation_gradient, &F_inverse_transposed = kinematics.dilatation_gradient;
    Matrix3d S = -F.transpose() * F;
    S.diagonal().array() += F.squaredNorm();
    return 2 * c10_ * (F - F_inverse_transposed) + 2 * c01_ * (F * S - 2 * F_inverse_transposed);
  }

  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override {
    // d(I1 F - F C) = 2 (F : dF) F + I1 dF - dF C - F dF^T F - F F^T dF, and as for neo-Hookean.
    const Matrix3d& F = kinematics.deformation_gradient;
    const double c10 = energy_weight * c10_, c01 = energy_weight * c01_;
    Matrix3d S = -2 * c01 * F.transpose() * F;
    S.diagonal().array() += 2 * (c10 + c01 * F.squaredNorm());
    addTransposingProduct(2 * (c10 + 2 * c01) - dilatation_weight, kinematics.dilatation_gradient, result);
    addTransposingProduct(-2 * c01, F, result);
    addOuterProduct(4 * c01, F, result);
    addRightProduct(S, result);
    addLeftProduct(-2 * c01 * F * F.transpose(), result);
  }

 private:
  double c10_;  ///< Pa
  double c01_;  ///< Pa
};

/// C = F^T F by the squares c of the principal stretches, largest last, and their directions at rest, the columns of V.
struct PrincipalStretches {
  explicit PrincipalStretches(const Matrix3d& F) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(F.transpose() * F);
    V = solver.eigenvectors();
    // Rounding is relative to the largest c. It must not make the smallest one zero or negative.
    c = solver.eigenvalues().cwiseMax(std::numeric_limits<double>::epsilon() * solver.eigenvalues()[2]);
  }

  Eigen::Vector3d c;
  Matrix3d V;
};

/// (a^p - b^p) / (a - b), p b^(p-1) for a = b; exact to rounding also for nearly equal a and b. @pre a, b > 0
double dividedDifferenceOfPower(double a, double b, double p) {
  const double t = a / b - 1;
  return std::pow(b, p - 1) * (t == 0 ? p : std::expm1(p * std::log1p(t)) / t);
}

/// Ogden's energy of one term (Ogden, "Large deformation isotropic elasticity - on the correlation of theory and
/// experiment for incompressible rubberlike solids", Proc. R. Soc. Lond. A 326, 1972) with the volumetric terms of
/// NeoHookean, which is alpha = 2: W = 2 mu / alpha^2 (sum_i l_i^alpha - 3) - 2 mu / alpha ln J + lambda/2 g^2, g = ln
/// J, with the principal stretches l_i, J = det F. At small strain the first two terms are mu sum_i (ln l_i)^2, so that
/// it is Hooke's law for any alpha. Infinite for J <= 0. The larger alpha, the more it stiffens in tension. With
/// lambda < 0 it softens for J below exp(2 mu / (alpha lambda)).
class Ogden : public Material {
 public:
  /// @param exponent alpha, >= 1: sum_i l_i^alpha is a convex function of F
  Ogden(const Lame& lame, double exponent)
      : Material(lame.lambda, lame), factor_(2 * lame.mu / exponent), power_(exponent / 2) {}

  Kinematics kinematics(const Matrix3d& F) const override { return logarithmicDilatation(F); }
  bool resistsInversion() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    const PrincipalStretches stretches(kinematics.deformation_gradient);
    const double sum = stretches.c.array().pow(power_).sum() - 3;
    return factor_ * (sum / (2 * power_) - kinematics.dilatation);
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    const PrincipalStretches stretches(kinematics.deformation_gradient);
    return kinematics.deformation_gradient * secondStress(stretches) - factor_ * kinematics.dilatation_gradient;
  }

  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override {
    // P = F S with S = factor C^p: dP = dF S + F dS, where in the directions v_i dS is dC times the divided differences
    // of factor c^p (Daleckii and Krein; Higham, "Functions of matrices", theorem 3.11), and dC_ij is dF : (F v_i v_j^T
    // + F v_j v_i^T).
    const PrincipalStretches stretches(kinematics.deformation_gradient);
    const Matrix3d deformed = kinematics.deformation_gradient * stretches.V;
    const double factor = energy_weight * factor_;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Matrix3d pair = deformed.col(i) * stretches.V.col(j).transpose();
        const Matrix3d other = deformed.col(j) * stretches.V.col(i).transpose();
        const double slope = dividedDifferenceOfPower(stretches.c[j], stretches.c[i], power_ - 1);
        addOuterProduct((i == j ? 0.5 : 1) * factor * slope, pair + other, result);
      }
    }
    addRightProduct(energy_weight * secondStress(stretches), result);
    addTransposingProduct(factor - dilatation_weight, kinematics.dilatation_gradient, result);
  }

 private:
  /// Second Piola-Kirchhoff stress of the first term, Pa.
  Matrix3d secondStress(const PrincipalStretches& stretches) const {
    const Eigen::Vector3d values = factor_ * stretches.c.array().pow(power_ - 1);
    return stretches.V * values.asDiagonal() * stretches.V.transpose();
  }

  double factor_;  ///< Pa, 2 mu / alpha
  double power_;   ///< alpha / 2, of the squares of the stretches
};

/// Gent: W = -mu Jm/2 ln(1 - (I1 - 3) / Jm) - mu ln J + lambda'/2 g^2, g = ln J, with I1 = tr(F^T F), J = det F (Gent,
/// "A new constitutive relation for rubber", Rubber Chemistry and Technology 69, 1996, whose rubber is incompressible).
/// lambda' = lambda - 2 mu / Jm gives Hooke's law at small strain, because the first term's (I1 - 3)^2 contributes one
/// in (tr e)^2. It is neo-Hookean for an infinite Jm. Infinite for J <= 0 and for I1 - 3 >= Jm, where its chains are
/// stretched out. With lambda' < 0, that is nu < 1 / (2 + Jm), it softens under strong compression.
class Gent : public Material {
 public:
  /// @param limit Jm, > 0
  Gent(const Lame& lame, double limit)
      : Material(lame.lambda - 2 * lame.mu / limit, lame), mu_(lame.mu), limit_(limit) {}

  Kinematics kinematics(const Matrix3d& F) const override { return logarithmicDilatation(F); }
  bool resistsInversion() const override { return true; }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    const double used = (kinematics.deformation_gradient.squaredNorm() - 3) / limit_;
    if (!(used < 1)) return std::numeric_limits<double>::infinity();
    return -mu_ * (0.5 * limit_ * std::log1p(-used) + kinematics.dilatation);
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    const Matrix3d& F = kinematics.deformation_gradient;
    return mu_ * (stiffening(F) * F - kinematics.dilatation_gradient);
  }

  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override {
    // ds = 2 s^2 / Jm F : dF, and as for neo-Hookean.
    const Matrix3d& F = kinematics.deformation_gradient;
    const double mu = energy_weight * mu_, s = stiffening(F);
    addOuterProduct(2 * mu * s * s / limit_, F, result);
    addTransposingProduct(mu - dilatation_weight, kinematics.dilatation_gradient, result);
    result.diagonal().array() += s * mu;
  }

 private:
  /// s = 2 / mu dW/dI1; 1 at rest.
  double stiffening(const Matrix3d& F) const { return limit_ / (limit_ - (F.squaredNorm() - 3)); }

  double mu_;     ///< Pa
  double limit_;  ///< Jm, of I1 - 3
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
  explicit StableNeoHookean(const Lame& lame)
      : Material(lame.lambda + 5.0 / 6 * lame.mu, lame), m_(4.0 / 3 * lame.mu) {}

  Kinematics kinematics(const Matrix3d& F) const override {
    const Matrix3d cofactor = cofactors(F);
    return {F, F.determinant() - 1, cofactor};
  }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    const double I = kinematics.deformation_gradient.squaredNorm();
    return m_ * (0.5 * (I - 3) - 0.5 * std::log((I + 1) / 4) - 0.75 * kinematics.dilatation);
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    const double stretching = m_ * (1 - 1 / (kinematics.deformation_gradient.squaredNorm() + 1));
    return stretching * kinematics.deformation_gradient - 0.75 * m_ * kinematics.dilatation_gradient;
  }

  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override {
    const Matrix3d& F = kinematics.deformation_gradient;
    const double m = energy_weight * m_, inverse = 1 / (F.squaredNorm() + 1);
    addOuterProduct(2 * m * inverse * inverse, F, result);
    result.diagonal().array() += m * (1 - inverse);
    // The columns f of F have the cofactors f_K x f_L, hence d(cof F)_J = df_K x f_L + f_K x df_L.
    const double weight = dilatation_weight - 0.75 * m;
    for (int J = 0; J < 3; ++J) {
      const int K = (J + 1) % 3, L = (J + 2) % 3;
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        result(i + 3 * J, j + 3 * K) += weight * F(k, L);
        result(i + 3 * J, k + 3 * K) -= weight * F(j, L);
        result(i + 3 * J, k + 3 * L) += weight * F(j, K);
        result(i + 3 * J, j + 3 * L) -= weight * F(k, K);
      }
    }
  }

 private:
  double m_;  ///< Pa
};

/// Corotated linear elasticity: W = mu |F - R|^2 + lambda/2 g^2, g = tr(R^T F) - 3, with R the
/// rotation nearest to F (Sifakis and Barbic, "FEM simulation of 3D deformable solids", 3.4). R is
/// in SO(3) also when F is inverted. It jumps there when the two smaller singular values of F
/// become equal (reflections), and W has a kink.
class Corotated : public Material {
 public:
  explicit Corotated(const Lame& lame) : Material(lame.lambda, lame), mu_(lame.mu) {}

  Kinematics kinematics(const Matrix3d& F) const override {
    const Matrix3d R = nearestRotation(F);
    return {F, R.cwiseProduct(F).sum() - 3, R};
  }

 protected:
  double modelEnergy(const Kinematics& kinematics) const override {
    return mu_ * (kinematics.deformation_gradient - kinematics.dilatation_gradient).squaredNorm();
  }

  Matrix3d modelStress(const Kinematics& kinematics) const override {
    return 2 * mu_ * (kinematics.deformation_gradient - kinematics.dilatation_gradient);
  }

  void addModelTangent(const Kinematics& kinematics, double energy_weight, double dilatation_weight,
                       Matrix9d& result) const override {
    // With S = R^T F: dR = R [w]x and (tr(S) I - S) w = axial(R^T dF - dF^T R). The eigenvalues of
    // the matrix are s_i + s_j, those of the twist modes of F.
    const Matrix3d& R = kinematics.dilatation_gradient;
    const Matrix3d S = R.transpose() * kinematics.deformation_gradient;
    Matrix3d twist = -0.5 * (S + S.transpose());
    twist.diagonal().array() += S.trace();
    const Matrix3d cofactor = cofactors(twist);
    // At a reflection (s_i + s_j = 0) R is not differentiable. The guard keeps the tangent finite.
    const double scale = std::max(twist.trace() / 3, 1e-6), guard = 1e-6 * scale * scale * scale;
    const double weight = (dilatation_weight - 2 * energy_weight * mu_) / std::max(twist.determinant(), guard);
    Eigen::Matrix<double, 3, 9> axial;
    axial << Eigen::RowVector3d::Zero(), R.col(2).transpose(), -R.col(1).transpose(),  //
        -R.col(2).transpose(), Eigen::RowVector3d::Zero(), R.col(0).transpose(),       //
        R.col(1).transpose(), -R.col(0).transpose(), Eigen::RowVector3d::Zero();
    const Eigen::Matrix<double, 3, 9> turn = weight * cofactor * axial;
    result.noalias() += axial.transpose().lazyProduct(turn);
    result.diagonal().array() += 2 * energy_weight * mu_;
  }

 private:
  double mu_;  ///< Pa
};

template <typename Model>
std::unique_ptr<Material> make(const Lame& lame, const MaterialConfig&) {
  return std::make_unique<Model>(lame);
}

std::unique_ptr<Material> makeMooneyRivlin(const Lame& lame, const MaterialConfig& config) {
  return std::make_unique<MooneyRivlin>(lame, config.mooney_ratio);
}

std::unique_ptr<Material> makeOgden(const Lame& lame, const MaterialConfig& config) {
  return std::make_unique<Ogden>(lame, config.ogden_exponent);
}

std::unique_ptr<Material> makeGent(const Lame& lame, const MaterialConfig& config) {
  return std::make_unique<Gent>(lame, config.gent_limit);
}

}  // namespace

const std::vector<std::pair<std::string, MaterialFactory>>& materialFactories() {
  static const std::vector<std::pair<std::string, MaterialFactory>> factories = {
      {"linear", make<LinearMaterial>},
      {"st_venant_kirchhoff", make<StVenantKirchhoff>},
      {"neo_hookean", make<NeoHookean>},
      {"mooney_rivlin", makeMooneyRivlin},
      {"ogden", makeOgden},
      {"gent", makeGent},
      {"stable_neo_hookean", make<StableNeoHookean>},
      {"corotated", make<Corotated>}};
  return factories;
}

}  // namespace microinjection
