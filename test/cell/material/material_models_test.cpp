#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "cell/material/lame.h"
#include "cell/material/material.h"
#include "cell/material/material_cases.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

const Matrix3d kRotation = Eigen::AngleAxisd(1.3, Vector3d(1, 2, -1).normalized()).toRotationMatrix();

TEST(NeoHookean, ResistsBeingCrushed) {
  const auto material = makeMaterial({"neo_hookean", kYoung, 0.3});
  Matrix3d F = Matrix3d::Identity();
  F(2, 2) = 1e-6;
  EXPECT_GT(material->energyDensity(F), 10 * kYoung);
  F(2, 2) = 0;
  EXPECT_TRUE(std::isinf(material->energyDensity(F)));
  F(2, 2) = -1;
  EXPECT_TRUE(std::isinf(material->energyDensity(F)));
}

TEST(NeoHookean, KnownUniaxialStress) {
  // nu = 0: lambda = 0, so that a stretch s with free sides is P = mu (s - 1 / s) along it.
  const auto material = makeMaterial({"neo_hookean", 2.0, 0.0});
  Matrix3d F = Matrix3d::Identity();
  F(0, 0) = 1.5;
  EXPECT_NEAR(material->stress(F)(0, 0), 1.5 - 1 / 1.5, 1e-14);
}

TEST(StVenantKirchhoff, KnownUniaxialStress) {
  const auto material = makeMaterial({"st_venant_kirchhoff", 2.0, 0.0});  // P = E/2 s (s^2 - 1)
  Matrix3d F = Matrix3d::Identity();
  F(0, 0) = 0.5;
  EXPECT_NEAR(material->stress(F)(0, 0), 0.5 * (0.25 - 1), 1e-14);
}

TEST(MooneyRivlin, RatioZeroIsNeoHookean) {
  for (const double nu : {-0.3, 0.3, 0.49}) {
    const auto mooney = makeMaterial({"mooney_rivlin", kYoung, nu, 0.0});
    const auto neo_hookean = makeMaterial({"neo_hookean", kYoung, nu});
    EXPECT_EQ(mooney->dilatationalModulus(), neo_hookean->dilatationalModulus());
    for (const Matrix3d& F : deformations()) {
      EXPECT_NEAR(mooney->energyDensity(F), neo_hookean->energyDensity(F), 1e-12 * kYoung);
      EXPECT_LT((mooney->stress(F) - neo_hookean->stress(F)).norm(), 1e-12 * neo_hookean->stress(F).norm());
      EXPECT_LT((mooney->tangent(F) - neo_hookean->tangent(F)).norm(), 1e-12 * neo_hookean->tangent(F).norm());
    }
  }
}

TEST(MooneyRivlin, KnownStressesOfSimpleShear) {
  // Rivlin: sigma_12 = mu g, sigma_11 - sigma_22 = mu g^2, sigma_22 - sigma_33 = -2 C01 g^2.
  const double ratio = 0.4, shear = 0.7, mu = Lame::from(kYoung, 0.45).mu;
  const auto material = makeMaterial({"mooney_rivlin", kYoung, 0.45, ratio});
  Matrix3d F = Matrix3d::Identity();
  F(0, 1) = shear;
  const Matrix3d cauchy = material->stress(F) * F.transpose();
  EXPECT_NEAR(cauchy(0, 1), mu * shear, 1e-12 * mu);
  EXPECT_NEAR(cauchy(0, 0) - cauchy(1, 1), mu * shear * shear, 1e-12 * mu);
  EXPECT_NEAR(cauchy(1, 1) - cauchy(2, 2), -ratio * mu * shear * shear, 1e-12 * mu);
}

std::unique_ptr<Material> ogden(double exponent, double poisson_ratio, double young = kYoung) {
  return makeMaterial({"ogden", young, poisson_ratio, 0, exponent});
}

std::unique_ptr<Material> gent(double limit, double poisson_ratio, double young = kYoung) {
  return makeMaterial({"gent", young, poisson_ratio, 0, 4, limit});
}

/// F of these stretches, turned before and after.
Matrix3d turned(const Vector3d& stretches) {
  static const Matrix3d axes = Eigen::AngleAxisd(0.4, Vector3d(-1, 1, 3).normalized()).toRotationMatrix();
  return kRotation * stretches.asDiagonal() * axes.transpose();
}

TEST(Ogden, ExponentTwoIsNeoHookean) {
  for (const double nu : {-0.3, 0.3, 0.49}) {
    const auto two = ogden(2, nu), neo_hookean = makeMaterial({"neo_hookean", kYoung, nu});
    EXPECT_EQ(two->dilatationalModulus(), neo_hookean->dilatationalModulus());
    for (const Matrix3d& F : deformations()) {
      EXPECT_NEAR(two->energyDensity(F), neo_hookean->energyDensity(F), 1e-12 * kYoung);
      EXPECT_LT((two->stress(F) - neo_hookean->stress(F)).norm(), 1e-12 * neo_hookean->stress(F).norm());
      EXPECT_LT((two->tangent(F) - neo_hookean->tangent(F)).norm(), 1e-12 * neo_hookean->tangent(F).norm());
    }
  }
}

TEST(Ogden, KnownUniaxialStress) {
  // nu = 0: a stretch s with free sides, which stay, is P = 2 mu / alpha (s^(alpha - 1) - 1 / s) along it.
  const auto material = ogden(5, 0, 2);
  for (const double s : {0.6, 1.5}) {
    const Matrix3d F = turned({s, 1, 1});
    const Matrix3d expected = F - turned({s - 0.4 * (std::pow(s, 4) - 1 / s), 1, 1});
    EXPECT_LT((material->stress(F) - expected).norm(), 1e-13);
  }
}

TEST(Ogden, IsTheEnergyOfThePrincipalStretches) {
  const Lame lame = Lame::from(kYoung, 0.45);
  for (const double alpha : {1.0, 3.0, 5.0, 30.0}) {
    const auto material = ogden(alpha, 0.45);
    for (const Vector3d& stretches :
         {Vector3d(1.3, 0.9, 0.8), Vector3d(0.6, 1.1, 1.1), Vector3d(1.2, 1.2, 1.2), Vector3d(2, 0.5, 0.01)}) {
      const Eigen::Array3d powers = stretches.array().pow(alpha);
      const double g = std::log(stretches.prod()), factor = 2 * lame.mu / alpha;
      const double energy = factor / alpha * (powers.sum() - 3) - factor * g + lame.lambda / 2 * g * g;
      const Vector3d stress = (factor * (powers - 1) + lame.lambda * g) / stretches.array();
      EXPECT_NEAR(material->energyDensity(turned(stretches)), energy, 1e-12 * (kYoung + energy));
      EXPECT_LT((material->stress(turned(stretches)) - turned(stress)).norm(), 1e-7 * stress.norm());
    }
  }
}

/// Where a formula by differences of the stretches loses its digits, or divides by zero.
TEST(Ogden, HasTheTangentOfEqualAndNearlyEqualStretches) {
  for (const double alpha : {1.0, 3.0, 5.0, 30.0}) {
    const auto material = ogden(alpha, 0.45);
    const auto stress = [&](const Matrix3d& F) { return material->stress(F); };
    for (const double gap : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.1}) {
      for (const Vector3d& ratios : {Vector3d(1, 1, 0.8), Vector3d(1, 1, 1.3), Vector3d(1, 1, 1)}) {
        const Matrix3d F = turned(1.1 * (ratios + gap * Vector3d(1, 0, -0.5)));
        EXPECT_LT(hessianError(stress, F, material->tangent(F)), 1e-6) << alpha << ", gap " << gap;
      }
    }
  }
}

/// The square of its smallest stretch is below the rounding error of C.
TEST(Ogden, IsFiniteWhereItIsCrushed) {
  for (const double alpha : {1.0, 3.0, 30.0}) {
    const Matrix3d F = turned({1.2, 0.9, 1e-10});
    ASSERT_GT(F.determinant(), 0);
    EXPECT_TRUE(std::isfinite(ogden(alpha, 0.45)->energyDensity(F)));
    EXPECT_TRUE(ogden(alpha, 0.45)->tangent(F).allFinite());
  }
}

TEST(Gent, LargeLimitIsNearlyNeoHookean) {
  const auto neo_hookean = makeMaterial({"neo_hookean", kYoung, 0.3});
  for (const Matrix3d& F : deformations()) {
    const auto off = [&](double limit) {
      const auto material = gent(limit, 0.3);
      const double energy = std::abs(material->energyDensity(F) / neo_hookean->energyDensity(F) - 1);
      const double stress = (material->stress(F) - neo_hookean->stress(F)).norm() / neo_hookean->stress(F).norm();
      const double tangent = (material->tangent(F) - neo_hookean->tangent(F)).norm() / neo_hookean->tangent(F).norm();
      return Vector3d(energy, stress, tangent);
    };
    const Vector3d large = off(1e4), small = off(1e3);
    EXPECT_LT(large.maxCoeff(), 1e-3);
    EXPECT_NEAR(small[0] / large[0], 10, 0.1);
    EXPECT_NEAR(small[1] / large[1], 10, 0.1);
    EXPECT_NEAR(small[2] / large[2], 10, 0.1);
  }
}

TEST(Gent, KnownUniaxialStress) {
  // Gent: at constant volume, sigma_11 - sigma_22 = mu Jm (s^2 - 1/s) / (Jm - I1 + 3), I1 = s^2 + 2/s.
  const double mu = Lame::from(kYoung, 0.45).mu, limit = 2;
  const auto material = gent(limit, 0.45);
  for (const double s : {0.5, 1.2, 1.8}) {
    Matrix3d F = Vector3d(s, 1 / std::sqrt(s), 1 / std::sqrt(s)).asDiagonal();
    const Matrix3d cauchy = material->stress(F) * F.transpose();
    const double expected = mu * limit * (s * s - 1 / s) / (limit - s * s - 2 / s + 3);
    EXPECT_NEAR(cauchy(0, 0) - cauchy(1, 1), expected, 1e-12 * std::abs(expected));
  }
}

TEST(Gent, RefusesWhatIsBeyondItsLimit) {
  const double infinity = std::numeric_limits<double>::infinity(), mu = Lame::from(kYoung, 0.49).mu, limit = 3;
  const auto material = gent(limit, 0.49);
  double last = 0;
  for (const double left : {1.0, 1e-1, 1e-3, 1e-6, 1e-9}) {  // of Jm - (I1 - 3)
    const Matrix3d F = Vector3d(std::sqrt(4 - left), 1, 1).asDiagonal();
    const double g = 0.5 * std::log(4 - left), volumetric = Lame::from(kYoung, 0.49).lambda - 2 * mu / limit;
    const double energy = -mu * limit / 2 * std::log(left / limit) - mu * g + volumetric / 2 * g * g;
    EXPECT_NEAR(material->energyDensity(F), energy, 1e-6 * energy);
    EXPECT_GT(material->stress(F).norm(), last);
    last = material->stress(F).norm();
  }
  EXPECT_GT(last, 1e6 * kYoung);
  for (const Vector3d& stretches :
       {Vector3d(2, 1, 1), Vector3d(2.1, 1, 1), Vector3d(1, 20, 1), Vector3d(0.1, 3, 0.1)}) {
    const Matrix3d F = turned(stretches * (1 + 1e-12));
    ASSERT_GT(F.determinant(), 0);
    EXPECT_EQ(material->energyDensity(F), infinity);
    EXPECT_EQ(distortionalEnergy(*material, F), infinity);
    EXPECT_EQ(material->energyDensity(material->kinematics(F), material->relaxing()), infinity);
  }
}

TEST(Gent, DerivativesNearItsLimit) {
  const auto material = gent(0.5, 0.45);
  const auto energy = [&](const Matrix3d& F) { return material->energyDensity(F); };
  const auto stress = [&](const Matrix3d& F) { return material->stress(F); };
  const Matrix3d F = turned({1.35, 0.87, 0.86});
  ASSERT_GT((F.squaredNorm() - 3) / 0.5, 0.5);
  EXPECT_LT(gradientError(energy, F, stress(F)), 1e-6);
  EXPECT_LT(hessianError(stress, F, material->tangent(F)), 1e-6);
}

TEST(StableNeoHookean, IsThePapersEnergy) {
  const Lame lame = Lame::from(kYoung, 0.45);
  const double mu = 4.0 / 3 * lame.mu, lambda = lame.lambda + 5.0 / 6 * lame.mu, alpha = 1 + 3 * mu / (4 * lambda);
  const auto energy = [&](const Matrix3d& F) {
    const double I = F.squaredNorm(), J = F.determinant();
    return mu / 2 * (I - 3) + lambda / 2 * (J - alpha) * (J - alpha) - mu / 2 * std::log(I + 1);
  };
  const auto material = makeMaterial({"stable_neo_hookean", kYoung, 0.45});
  for (const auto& states : {deformations(), inversions()}) {
    for (const Matrix3d& F : states) {
      const double expected = energy(F) - energy(Matrix3d::Identity());
      EXPECT_NEAR(material->energyDensity(F), expected, 1e-12 * (lambda + expected));
      EXPECT_GT(material->energyDensity(F), 0);
    }
  }
}

TEST(Corotated, KnownUniaxialStressAlsoInsideOut) {
  const auto material = makeMaterial({"corotated", 2.0, 0.0});  // P = E (s - 1)
  for (const double stretch : {2.0, 0.5, 1e-9, 0.0, -0.5}) {
    const Vector3d stretches(stretch, 1, 1);
    const Matrix3d stress = material->stress(kRotation * stretches.asDiagonal());
    EXPECT_NEAR((kRotation.transpose() * stress)(0, 0), 2 * (stretch - 1), 1e-12);
  }
}

TEST(Corotated, FindsTheRotationOfAnyStretch) {
  const auto material = makeMaterial({"corotated", kYoung, 0.3});
  const Matrix3d axes = Eigen::AngleAxisd(0.4, Vector3d(-1, 1, 3).normalized()).toRotationMatrix();
  for (const Vector3d& stretches : {Vector3d(1.1, 0.9, 1.05), Vector3d(3, 0.4, 0.1), Vector3d(1e-3, 2, 1.5),
                                    Vector3d(1.2, -0.3, 0.8), Vector3d(40, 30, 20), Vector3d(1.5, 1.5, 0)}) {
    const Matrix3d F = kRotation * axes * stretches.asDiagonal() * axes.transpose();
    EXPECT_LT((dilatationGradient(*material, F) - kRotation).norm(), 1e-11) << stretches.transpose();
    EXPECT_NEAR(material->dilatation(F), stretches.sum() - 3, 1e-11);
  }
}

TEST(Corotated, StaysFiniteWhereTheRotationIsNotUnique) {
  const auto material = makeMaterial({"corotated", kYoung, 0.3});
  for (const Vector3d& stretches : {Vector3d(1, 1, -1), Vector3d(1, 0, 0), Vector3d(0, 0, 0)}) {
    const Matrix3d F = stretches.asDiagonal();
    EXPECT_TRUE(std::isfinite(material->energyDensity(F)));
    EXPECT_TRUE(material->stress(F).allFinite());
    EXPECT_TRUE(material->tangent(F).allFinite());
  }
}

TEST(MaterialConfig, RefusesBadValuesAllAtOnce) {
  EXPECT_NO_THROW(makeMaterial({"linear", 1, -0.9}));
  for (const double young : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(makeMaterial({"linear", young, 0.3}), ConfigError);
  }
  for (const double poisson : {-1.0, 0.5, 0.6, std::nan("")}) {
    EXPECT_THROW(makeMaterial({"neo_hookean", 1, poisson}), ConfigError);
  }
  for (const double ratio : {-0.1, 1.1, std::nan("")}) {
    EXPECT_THROW(makeMaterial({"mooney_rivlin", 1, 0.3, ratio}), ConfigError);
  }
  for (const double exponent : {0.9, 31.0, std::nan("")}) EXPECT_THROW(ogden(exponent, 0.3), ConfigError);
  for (const double limit : {0.0, 0.09, 2e4}) EXPECT_THROW(gent(limit, 0.3), ConfigError);
  try {
    makeMaterial({"rubber", -3, 0.7, 2, 0, -1, {{{1, 0}, {-1, 5}}, -4}});
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    for (const char* line :
         {"material: model = rubber: must be one of: linear, st_venant_kirchhoff, neo_hookean, ",
          "material: young_modulus = -3 Pa: must be in (0, inf) Pa",
          "material: poisson_ratio = 0.7: must be in (-1, 0.5)", "material: mooney_ratio = 2: must be in [0, 1]",
          "material: ogden_exponent = 0: must be in [1, 30]", "material: gent_limit = -1: must be in [0.1, 10000]",
          "material: viscoelasticity/prony[0]/relaxation_time = 0 s: must be in (0, inf) s",
          "material: viscoelasticity/prony[1]/modulus_ratio = -1: must be in (0, inf)",
          "material: viscoelasticity/viscosity = -4 Pa s: must be in [0, inf) Pa s"}) {
      EXPECT_NE(text.find(line), std::string::npos) << line << "\nis not in\n" << text;
    }
  }
}

}  // namespace
}  // namespace microinjection
