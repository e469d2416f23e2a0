#include "material/material.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "base/errors.h"
#include "base/finite_difference.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;

constexpr double kYoung = 17.9e3;  // Pa

/// Every material, at ordinary and nearly incompressible Poisson's ratios.
class MaterialTest : public testing::TestWithParam<std::tuple<std::string, double>> {
 protected:
  MaterialConfig config() const { return {std::get<0>(GetParam()), kYoung, std::get<1>(GetParam())}; }

  /// Deformations of some 20 % with det F > 0.
  std::vector<Matrix3d> deformations() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> entry(-0.2, 0.2);
    std::vector<Matrix3d> result;
    for (int i = 0; i < 20; ++i) {
      result.push_back(Matrix3d::Identity() + Matrix3d::NullaryExpr([&] { return entry(random); }));
    }
    return result;
  }

  static Eigen::VectorXd flat(const Matrix3d& matrix) { return matrix.reshaped(); }
  static Matrix3d square(const Eigen::VectorXd& vector) { return vector.reshaped(3, 3); }

  const std::unique_ptr<Material> material_ = makeMaterial(config());
};

TEST_P(MaterialTest, UndeformedStateHasNoEnergyAndNoStress) {
  EXPECT_EQ(material_->energyDensity(Matrix3d::Identity()), 0);
  EXPECT_EQ(material_->stress(Matrix3d::Identity()).norm(), 0);
}

TEST_P(MaterialTest, EnergyIsPositiveWhenDeformed) {
  for (const Matrix3d& F : deformations()) EXPECT_GT(material_->energyDensity(F), 0);
}

TEST_P(MaterialTest, StressIsTheDerivativeOfTheEnergy) {
  const auto energy = [&](const Eigen::VectorXd& F) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, material_->energyDensity(square(F))));
  };
  for (const Matrix3d& F : deformations()) {
    EXPECT_LT(derivativeError(energy, flat(F), flat(material_->stress(F)).transpose(), 1e-5), 1e-6);
  }
}

TEST_P(MaterialTest, TangentIsTheDerivativeOfTheStressAndSymmetric) {
  const auto stress = [&](const Eigen::VectorXd& F) { return flat(material_->stress(square(F))); };
  for (const Matrix3d& F : deformations()) {
    const Material::Matrix9d tangent = material_->tangent(F);
    EXPECT_LT(derivativeError(stress, flat(F), tangent, 1e-5), 1e-6);
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
    EXPECT_LT((tangent * flat(gradient) - flat(expected)).norm(), 1e-12 * expected.norm());
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

std::string testName(const testing::TestParamInfo<MaterialTest::ParamType>& info) {
  return std::get<0>(info.param) + "_nu_" + std::to_string(static_cast<int>(100 * std::get<1>(info.param)));
}

INSTANTIATE_TEST_SUITE_P(All, MaterialTest,
                         testing::Combine(testing::ValuesIn(materialModels()), testing::Values(0.0, 0.3, 0.49)),
                         testName);

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

TEST(MaterialConfig, RefusesBadValuesAllAtOnce) {
  EXPECT_NO_THROW(makeMaterial({"linear", 1, -0.9}));
  for (const double young : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(makeMaterial({"linear", young, 0.3}), ConfigError);
  }
  for (const double poisson : {-1.0, 0.5, 0.6, std::nan("")}) {
    EXPECT_THROW(makeMaterial({"neo_hookean", 1, poisson}), ConfigError);
  }
  try {
    makeMaterial({"rubber", -3, 0.7});
    FAIL();
  } catch (const ConfigError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("model = rubber: must be one of: linear, st_venant_kirchhoff, neo_hookean"), std::string::npos);
    EXPECT_NE(text.find("young_modulus = -3"), std::string::npos);
    EXPECT_NE(text.find("poisson_ratio = 0.7: must be in (-1, 0.5)"), std::string::npos);
  }
}

}  // namespace
}  // namespace microinjection
