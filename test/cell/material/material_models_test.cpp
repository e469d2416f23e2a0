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
  try {
    makeMaterial({"rubber", -3, 0.7, 2, {{{1, 0}, {-1, 5}}, -4}});
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    for (const char* line :
         {"material: model = rubber: must be one of: linear, st_venant_kirchhoff, neo_hookean, ",
          "material: young_modulus = -3 Pa: must be in (0, inf) Pa",
          "material: poisson_ratio = 0.7: must be in (-1, 0.5)", "material: mooney_ratio = 2: must be in [0, 1]",
          "material: viscoelasticity/prony[0]/relaxation_time = 0 s: must be in (0, inf) s",
          "material: viscoelasticity/prony[1]/modulus_ratio = -1: must be in (0, inf)",
          "material: viscoelasticity/viscosity = -4 Pa s: must be in [0, inf) Pa s"}) {
      EXPECT_NE(text.find(line), std::string::npos) << line << "\nis not in\n" << text;
    }
  }
}

}  // namespace
}  // namespace microinjection
