#include "cell/material/viscoelasticity.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/errors.h"
#include "cell/material/lame.h"
#include "cell/material/material_cases.h"
#include "cell/material/viscoelastic_step.h"

namespace microinjection {
namespace {

using Eigen::Matrix3d;

constexpr double kForever = std::numeric_limits<double>::infinity();
const ViscoelasticityConfig kProny = {{{0.8, 0.1}, {1.5, 2.0}}};
const ViscoelasticityConfig kAll = {{{0.8, 0.1}, {1.5, 2.0}}, 500};  // Pa s

/// A material and one point of it.
class ViscoelasticTest : public MaterialCases {
 protected:
  void step(const ViscoelasticityConfig& config, double dt, const Matrix3d& F) {
    ViscoelasticStep(*material_, config, dt).accept(material_->kinematics(F), memory_);
  }
  Matrix3d stress(const ViscoelasticityConfig& config, double dt, const Matrix3d& F) const {
    return ViscoelasticStep(*material_, config, dt).stress(memory_, material_->kinematics(F));
  }
  Matrix3d relaxing(const Matrix3d& F) const {
    return material_->stress(material_->kinematics(F), material_->relaxing());
  }

  ViscoelasticMemory memory_{kAll};
};

TEST_P(ViscoelasticTest, DerivativesOfThePotential) {
  const std::vector<Matrix3d> states = deformations();
  for (size_t i = 0; i < states.size(); ++i) {
    const ViscoelasticStep next(*material_, kAll, 0.05 * (1 + i));
    const auto energy = [&](const Matrix3d& F) { return next.energy(memory_, material_->kinematics(F)); };
    const auto stress = [&](const Matrix3d& F) { return next.stress(memory_, material_->kinematics(F)); };
    const Material::Matrix9d tangent = next.tangent(memory_, material_->kinematics(states[i]));
    EXPECT_LT(gradientError(energy, states[i], stress(states[i])), 1e-6);
    EXPECT_LT(hessianError(stress, states[i], tangent), 1e-6);
    EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-13 * tangent.norm());
    next.accept(material_->kinematics(states[i]), memory_);
  }
}

TEST_P(ViscoelasticTest, NothingAtRest) {
  const Matrix3d undeformed = Matrix3d::Identity();
  const ViscoelasticStep rest(*material_, kAll, 0.1);
  EXPECT_EQ(rest.energy(memory_, material_->kinematics(undeformed)), 0);
  EXPECT_EQ(stress(kAll, 0.1, undeformed).norm(), 0);
  step(kAll, 0.1, undeformed);
  EXPECT_EQ(stress(kAll, 0.1, undeformed).norm(), 0);
}

TEST_P(ViscoelasticTest, StressOfAStepStrainRelaxesAsThePronySeries) {
  const Matrix3d F = deformations()[0];
  step(kProny, 1e-12, F);
  double time = 0;
  for (const double dt : {0.01, 0.04, 0.3, 2.0, 5.0}) {
    time += dt;
    const double modulus = 0.8 * std::exp(-time / 0.1) + 1.5 * std::exp(-time / 2.0);
    const Matrix3d expected = modulus * relaxing(F);
    EXPECT_LT((stress(kProny, dt, F) - expected).norm(), 1e-9 * expected.norm()) << time;
    step(kProny, dt, F);
  }
}

TEST_P(ViscoelasticTest, FastStepAddsEveryBranchAndSlowStepNone) {
  const Matrix3d F = deformations()[3];
  const double scale = relaxing(F).norm();
  EXPECT_LT((stress(kProny, 1e-9, F) - (0.8 + 1.5) * relaxing(F)).norm(), 1e-7 * scale);
  EXPECT_LT(stress(kAll, 1e9, F).norm(), 1e-6 * scale);
  if (config().poisson_ratio > 0.4) {  // here the relaxing part is the whole distortional one
    EXPECT_LT((relaxing(F) - distortionalStress(*material_, F)).norm(), 1e-13 * material_->dilatationalModulus());
  }
}

TEST_P(ViscoelasticTest, ForeverIsElastic) {
  const Matrix3d before = deformations()[1], F = deformations()[2];
  step(kAll, 0.1, before);
  const ViscoelasticStep relaxed(*material_, kAll, kForever);
  EXPECT_EQ(relaxed.energy(memory_, material_->kinematics(F)), 0);
  EXPECT_EQ(relaxed.stress(memory_, material_->kinematics(F)).norm(), 0);
  EXPECT_EQ(relaxed.tangent(memory_, material_->kinematics(F)).norm(), 0);
  step(kAll, kForever, F);
  EXPECT_LT(stress(kAll, 0.1, F).norm(), 1e-12 * relaxing(F).norm());  // remembers that F is where it relaxed
  for (const Matrix3d& Q : memory_.branch_stresses) EXPECT_EQ(Q.norm(), 0);
}

TEST_P(ViscoelasticTest, DoesNotSeeRotationsUnlessStrainIsSmall) {
  if (material_->isLinear()) return;
  const Matrix3d rotation = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Matrix3d F = deformations()[2];
  step(kAll, 0.3, deformations()[1]);
  const Matrix3d expected = rotation * stress(kAll, 0.1, F);
  EXPECT_LT((stress(kAll, 0.1, rotation * F) - expected).norm(), 1e-10 * expected.norm());
  step(kAll, 1e3, F);  // only the rotation is left to be fast
  const double still = stress(kAll, 1e-3, F).norm();
  EXPECT_NEAR(stress(kAll, 1e-3, rotation * F).norm(), still, 1e-8 * relaxing(F).norm());
}

TEST_P(ViscoelasticTest, AClosedCycleDissipates) {
  const Matrix3d far = deformations()[4];
  double work = 0;
  Matrix3d F = Matrix3d::Identity();
  constexpr int kSteps = 200;
  for (int i = 1; i <= kSteps; ++i) {
    const Matrix3d next = Matrix3d::Identity() + std::sin(M_PI * i / kSteps) * (far - Matrix3d::Identity());
    const Matrix3d middle = 0.5 * (F + next);
    step(kAll, 0.005, middle);
    work += stress(kAll, 0.005, next).cwiseProduct(next - F).sum();
    step(kAll, 0.005, next);
    F = next;
  }
  EXPECT_GT(work, 0.1 * relaxing(far).cwiseProduct(far - Matrix3d::Identity()).sum());
}

INSTANTIATE_TEST_SUITE_P(All, ViscoelasticTest, everyMaterial(), caseName);

TEST(ViscoelasticStep, RampOfALinearMaterialIsExactForAnyStep) {
  // At a constant rate of strain e' each branch carries beta 2 mu e' tau (1 - exp(-t/tau)).
  const auto material = makeMaterial({"linear", kYoung, 0.0});
  const double mu = Lame::from(kYoung, 0.0).mu, rate = 0.02;  // 1/s
  ViscoelasticMemory memory(kProny);
  double time = 0;
  for (const double dt : {0.001, 0.1, 3.0, 0.02}) {
    time += dt;
    Matrix3d F = Matrix3d::Identity();
    F(0, 0) += rate * time;
    const ViscoelasticStep step(*material, kProny, dt);
    const double stress = step.stress(memory, material->kinematics(F))(0, 0);
    const double expected = 2 * mu * rate * (0.8 * 0.1 * -std::expm1(-time / 0.1) + 1.5 * 2 * -std::expm1(-time / 2));
    EXPECT_NEAR(stress, expected, 1e-11 * expected);
    step.accept(material->kinematics(F), memory);
  }
}

TEST(ViscoelasticStep, ViscosityIsNewtonsAtSmallStrain) {
  const double viscosity = 3, dt = 0.01, shear = 1e-7;  // Pa s, s, -
  for (const std::string& model : materialModels()) {
    const auto material = makeMaterial({model, kYoung, 0.3});
    const ViscoelasticityConfig config = {{}, viscosity};
    Matrix3d F = Matrix3d::Identity();
    F(0, 1) = shear;
    const ViscoelasticStep step(*material, config, dt);
    EXPECT_NEAR(step.stress(ViscoelasticMemory(config), material->kinematics(F))(0, 1), viscosity * shear / dt,
                1e-6 * viscosity * shear / dt)
        << model;
  }
}

TEST(ViscoelasticStep, ConvergesWithTheSecondOrderOfTheStep) {
  // A large stretch in one second: halving the steps divides the error by four.
  const auto material = makeMaterial({"neo_hookean", kYoung, 0.49});
  const auto stressAfter = [&](int steps) {
    ViscoelasticMemory memory(kProny);
    Matrix3d F = Matrix3d::Identity(), stress;
    for (int i = 1; i <= steps; ++i) {
      F(0, 0) = 1 + 0.5 * i / steps;
      const ViscoelasticStep step(*material, kProny, 1.0 / steps);
      stress = step.stress(memory, material->kinematics(F));
      step.accept(material->kinematics(F), memory);
    }
    return stress(0, 0);
  };
  const double exact = stressAfter(4096);
  const double ratio = (stressAfter(32) - exact) / (stressAfter(64) - exact);
  EXPECT_NEAR(ratio, 4, 0.1);
}

TEST(ViscoelasticStep, RefusesStepsThatAreNone) {
  const auto material = makeMaterial({});
  for (const double dt : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(ViscoelasticStep(*material, kAll, dt), std::invalid_argument);
  }
}

TEST(ViscoelasticityConfig, RefusesBadValuesAllAtOnce) {
  EXPECT_TRUE(ViscoelasticityConfig().empty());
  EXPECT_FALSE(kProny.empty());
  EXPECT_FALSE((ViscoelasticityConfig{{}, 1}).empty());
  ConfigErrors errors;
  kAll.check("viscoelasticity: ", errors);
  EXPECT_TRUE(errors.good());
  const ViscoelasticityConfig bad = {{{1, kForever}, {std::nan(""), 1}}, kForever};
  bad.check("viscoelasticity: ", errors);
  for (const char* line : {"viscoelasticity: prony[0]/relaxation_time = inf s: must be in (0, inf) s",
                           "viscoelasticity: prony[1]/modulus_ratio = nan: must be in (0, inf)",
                           "viscoelasticity: viscosity = inf Pa s: must be in [0, inf) Pa s"}) {
    EXPECT_EQ(std::count(errors.messages().begin(), errors.messages().end(), line), 1) << line;
  }
  EXPECT_EQ(errors.messages().size(), 3u);
}

}  // namespace
}  // namespace microinjection
