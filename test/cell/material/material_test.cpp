#include "cell/material/material.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "cell/material/material_cases.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;

class MaterialTest : public MaterialCases {};

TEST_P(MaterialTest, UndeformedStateHasNoEnergyAndNoStress) {
  EXPECT_EQ(material_->energyDensity(Matrix3d::Identity()), 0);
  EXPECT_EQ(material_->stress(Matrix3d::Identity()).norm(), 0);
}

TEST_P(MaterialTest, EnergyIsPositiveWhenDeformed) {
  for (const Matrix3d& F : deformations()) EXPECT_GT(material_->energyDensity(F), 0);
}

TEST_P(MaterialTest, StressIsTheDerivativeOfTheEnergy) {
  for (const Matrix3d& F : deformations()) {
    const auto energy = [&](const Matrix3d& at) { return material_->energyDensity(at); };
    EXPECT_LT(gradientError(energy, F, material_->stress(F)), 1e-6);
  }
}

TEST_P(MaterialTest, TangentIsTheDerivativeOfTheStressAndSymmetric) {
  for (const Matrix3d& F : deformations()) {
    const Material::Matrix9d tangent = material_->tangent(F);
    EXPECT_LT(hessianError([&](const Matrix3d& at) { return material_->stress(at); }, F, tangent), 1e-6);
    EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-13 * tangent.norm());
  }
}

TEST_P(MaterialTest, UndeformedTangentIsHookesLaw) {
  const double nu = config().poisson_ratio, mu = kYoung / (2 * (1 + nu));
  const double lambda = kYoung * nu / ((1 + nu) * (1 - 2 * nu));
  const Material::Matrix9d tangent = material_->tangent(Matrix3d::Identity());
  for (const Matrix3d& F : deformations()) {
    const Matrix3d gradient = F - Matrix3d::Identity(), strain = 0.5 * (gradient + gradient.transpose());
    const Matrix3d expected = 2 * mu * strain + lambda * strain.trace() * Matrix3d::Identity();
    EXPECT_LT((tangent * flatVector(gradient) - flatVector(expected)).norm(), 1e-12 * expected.norm());
  }
}

TEST_P(MaterialTest, UndeformedTangentIsPositiveDefiniteButForRotations) {
  const Eigen::SelfAdjointEigenSolver<Material::Matrix9d> solver(material_->tangent(Matrix3d::Identity()));
  const Eigen::VectorXd values = solver.eigenvalues() / kYoung;
  EXPECT_LT(values.head<3>().cwiseAbs().maxCoeff(), 1e-10);  // three infinitesimal rotations
  EXPECT_GT(values[3], 0.1);
}

TEST_P(MaterialTest, EnergyDoesNotSeeRotationsUnlessStrainIsSmall) {
  const Matrix3d rotation = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  for (const Matrix3d& F : deformations()) {
    const double energy = material_->energyDensity(F), rotated = material_->energyDensity(rotation * F);
    if (material_->isLinear()) {
      EXPECT_GT(std::abs(rotated - energy), 0.1 * energy);
    } else {
      EXPECT_NEAR(rotated, energy, 1e-10 * (energy + kYoung));
      EXPECT_LT((material_->stress(rotation * F) - rotation * material_->stress(F)).norm(),
                1e-10 * material_->stress(F).norm());
    }
  }
}

TEST_P(MaterialTest, InvertedStateIsRefusedOrSmooth) {
  const auto energy = [&](const Matrix3d& F) { return material_->energyDensity(F); };
  const auto stress = [&](const Matrix3d& F) { return material_->stress(F); };
  for (const Matrix3d& F : inversions()) {
    ASSERT_LT(F.determinant(), 0);
    if (material_->resistsInversion()) {
      EXPECT_EQ(energy(F), std::numeric_limits<double>::infinity());
      EXPECT_EQ(distortionalEnergy(*material_, F), std::numeric_limits<double>::infinity());
    } else {
      EXPECT_LT(gradientError(energy, F, stress(F)), 1e-6);
      EXPECT_LT(hessianError(stress, F, material_->tangent(F)), 1e-6);
    }
  }
}

TEST_P(MaterialTest, FlatStateIsRefusedOrFinite) {
  Matrix3d F = Matrix3d::Identity();
  F(2, 2) = 0;
  if (material_->resistsInversion()) {
    EXPECT_EQ(material_->energyDensity(F), std::numeric_limits<double>::infinity());
  } else {
    EXPECT_TRUE(std::isfinite(material_->energyDensity(F)));
    EXPECT_TRUE(material_->stress(F).allFinite());
    EXPECT_TRUE(material_->tangent(F).allFinite());
  }
}

INSTANTIATE_TEST_SUITE_P(All, MaterialTest, everyMaterial(), caseName);

}  // namespace
}  // namespace microinjection
