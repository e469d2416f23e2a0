#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "cell/material/lame.h"
#include "cell/material/material.h"
#include "cell/material/material_cases.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;

/// The distortional part and the dilatation of every material.
class MaterialPartsTest : public MaterialCases {};

TEST_P(MaterialPartsTest, UndeformedStateHasNone) {
  const Matrix3d undeformed = Matrix3d::Identity();
  EXPECT_EQ(distortionalEnergy(*material_, undeformed), 0);
  EXPECT_EQ(distortionalStress(*material_, undeformed).norm(), 0);
  EXPECT_EQ(material_->dilatation(undeformed), 0);
  EXPECT_EQ(dilatationGradient(*material_, undeformed), undeformed);
}

TEST_P(MaterialPartsTest, DistortionalDerivatives) {
  const auto energy = [&](const Matrix3d& F) { return distortionalEnergy(*material_, F); };
  const auto stress = [&](const Matrix3d& F) { return distortionalStress(*material_, F); };
  for (const Matrix3d& F : deformations()) {
    EXPECT_LT(gradientError(energy, F, stress(F)), 1e-6);
    EXPECT_LT(hessianError(stress, F, material_->distortionalTangent(F)), 1e-6);
  }
}

TEST_P(MaterialPartsTest, DilatationalDerivatives) {
  const auto dilatation = [&](const Matrix3d& F) { return material_->dilatation(F); };
  const auto gradient = [&](const Matrix3d& F) { return dilatationGradient(*material_, F); };
  for (const Matrix3d& F : deformations()) {
    EXPECT_LT(gradientError(dilatation, F, gradient(F)), 1e-6);
    if (material_->isLinear()) {
      EXPECT_EQ(dilatationHessian(*material_, F).norm(), 0);
    } else {
      EXPECT_LT(hessianError(gradient, F, dilatationHessian(*material_, F)), 1e-6);
    }
  }
}

TEST_P(MaterialPartsTest, InvertedPartsAreSmooth) {
  if (material_->resistsInversion()) return;
  const auto gradient = [&](const Matrix3d& F) { return dilatationGradient(*material_, F); };
  const auto stress = [&](const Matrix3d& F) { return distortionalStress(*material_, F); };
  for (const Matrix3d& F : inversions()) {
    EXPECT_LT(gradientError([&](const Matrix3d& at) { return material_->dilatation(at); }, F, gradient(F)), 1e-6);
    EXPECT_LT(hessianError(stress, F, material_->distortionalTangent(F)), 1e-6);
  }
}

TEST_P(MaterialPartsTest, SumUpToTheWhole) {
  const double kappa = material_->dilatationalModulus();
  for (const Matrix3d& F : deformations()) {
    const double g = material_->dilatation(F);
    const Matrix3d gradient = dilatationGradient(*material_, F);
    const Material::Matrix9d squared = flatVector(gradient) * flatVector(gradient).transpose();
    const double energy = distortionalEnergy(*material_, F) + 0.5 * kappa * g * g;
    const Matrix3d stress = distortionalStress(*material_, F) + kappa * g * gradient;
    const Material::Matrix9d tangent =
        material_->distortionalTangent(F) + kappa * (squared + g * dilatationHessian(*material_, F));
    EXPECT_NEAR(material_->energyDensity(F), energy, 1e-13 * (kappa + kYoung));
    EXPECT_LT((material_->stress(F) - stress).norm(), 1e-13 * (kappa + kYoung));
    EXPECT_LT((material_->tangent(F) - tangent).norm(), 1e-13 * tangent.norm());
  }
}

TEST_P(MaterialPartsTest, MixedIsTheWholeAtThePressureOfTheDilatation) {
  const double kappa = material_->dilatationalModulus();
  for (const Matrix3d& F : deformations()) {
    const Material::Kinematics at = material_->kinematics(F);
    const double pressure = kappa * at.dilatation;
    const Material::Weights mixed = Material::mixed(1, pressure);
    EXPECT_NEAR(material_->energyDensity(at, mixed) - pressure * pressure / (2 * kappa), material_->energyDensity(F),
                1e-13 * (kappa + kYoung));
    EXPECT_LT((material_->stress(at, mixed) - material_->stress(F)).norm(), 1e-13 * (kappa + kYoung));
  }
}

TEST_P(MaterialPartsTest, WeightsCombineTheParts) {
  const double a = 1.7, p = 0.3 * kYoung, k = -0.6 * kYoung;
  for (const Matrix3d& F : deformations(5)) {
    const Material::Kinematics at = material_->kinematics(F);
    const double g = at.dilatation;
    const Matrix3d gradient = at.dilatation_gradient;
    const Material::Matrix9d squared = flatVector(gradient) * flatVector(gradient).transpose();
    EXPECT_NEAR(material_->energyDensity(at, {a, p, k}),
                a * distortionalEnergy(*material_, F) + p * g + 0.5 * k * g * g, 1e-13 * kYoung);
    const Matrix3d stress = a * distortionalStress(*material_, F) + (p + k * g) * gradient;
    EXPECT_LT((material_->stress(at, {a, p, k}) - stress).norm(), 1e-13 * kYoung);
    const Material::Matrix9d tangent =
        a * material_->distortionalTangent(F) + (p + k * g) * dilatationHessian(*material_, F) + k * squared;
    EXPECT_LT((material_->tangent(at, {a, p, k}) - tangent).norm(), 1e-12 * kYoung);
  }
}

TEST_P(MaterialPartsTest, RelaxingPartResistsChangesOfVolume) {
  if (config().model == "stable_neo_hookean") return;  // its distortional part does not at any Poisson's ratio
  const Material::Kinematics swollen = material_->kinematics(1.01 * Matrix3d::Identity());
  EXPECT_GT(material_->energyDensity(swollen, material_->relaxing()), 0);
}

TEST_P(MaterialPartsTest, ModulusIsPositiveAndLeavesAStableRest) {
  const Lame lame = Lame::from(kYoung, config().poisson_ratio);
  EXPECT_GT(material_->dilatationalModulus(), 0);
  if (config().model == "neo_hookean" || config().model == "linear") {
    EXPECT_GE(material_->dilatationalModulus(), lame.lambda);
    EXPECT_LE(material_->dilatationalModulus(), lame.lambda + 2 * lame.mu / 3 + 1e-9 * kYoung);
    if (lame.lambda > lame.mu) EXPECT_EQ(material_->dilatationalModulus(), lame.lambda);
  }
  if (config().model == "stable_neo_hookean") EXPECT_GT(material_->dilatationalModulus(), lame.lambda);
}

TEST_P(MaterialPartsTest, DilatationDoesNotSeeRotationsUnlessStrainIsSmall) {
  if (material_->isLinear()) return;
  const Matrix3d rotation = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 1).normalized()).toRotationMatrix();
  for (const Matrix3d& F : deformations()) {
    EXPECT_NEAR(material_->dilatation(rotation * F), material_->dilatation(F), 1e-12);
    EXPECT_LT((dilatationGradient(*material_, rotation * F) - rotation * dilatationGradient(*material_, F)).norm(),
              1e-12);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MaterialPartsTest, everyMaterial(), caseName);

}  // namespace
}  // namespace microinjection
