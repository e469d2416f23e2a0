#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bodies.h"
#include "cell/material/lame.h"
#include "cell/mechanics/load_path.h"
#include "cell/mechanics/viscous_cases.h"
#include "cell/mechanics/viscous_stress.h"

namespace microinjection {
namespace {

constexpr double kYoungModulus = 2;  // Pa, of bodies.h

/// The sum of the branches' moduli a time after a sudden strain, relative to the long-term one.
double relaxation(double time) { return 0.8 * std::exp(-time / 0.1) + 1.5 * std::exp(-time / 2.0); }

/// A body with its viscous stress, each load step as long as asked for.
template <int Dim>
struct ViscousProblem {
  ViscousProblem(std::shared_ptr<LayeredBody<Dim>> of, const ViscoelasticityConfig& config,
                 const Constraints& constraints, double largest_step = 10)
      : body(of),
        viscous(std::make_shared<ViscousStress<Dim>>(of, std::vector<ViscoelasticityConfig>{config})),
        system({body, viscous}, constraints, methodFor(body->kind())),
        path(system, pathConfig(largest_step)) {}

  static LoadPathConfig pathConfig(double largest_step) {
    LoadPathConfig config;
    config.length = 1;
    config.first_step = config.largest_step = largest_step;
    config.smallest_step = 1e-5;
    return config;
  }

  /// N, after a motion to `target` (m) in `duration` (s).
  Eigen::Vector3d reaction(const Eigen::Vector3d& target, double duration) {
    const LoadPath::Result result = path.advance(target, duration);
    EXPECT_TRUE(result.converged) << result.reason;
    return path.reaction();
  }

  std::shared_ptr<LayeredBody<Dim>> body;
  std::shared_ptr<ViscousStress<Dim>> viscous;
  EquilibriumSystem system;
  LoadPath path;
};

/// Only component k of the displacement is free: between two plates any material is deformed uniformly.
template <int Dim>
Constraints onlyAlong(int k, const LayeredBody<Dim>& body) {
  Constraints constraints = betweenPlates(body);
  for (int n = 0; n < body.nodeCount(); ++n) {
    for (int i = 0; i < Dim; ++i) {
      if (i != k) constraints.entries[Dim * n + i] = Constraints::kFixed;
    }
  }
  return constraints;
}

ViscousProblem<3> simpleShear(const std::string& model, const ViscoelasticityConfig& config) {
  const auto body = makeBody(irregularBlock<3>(2), ElementKind::kP2P0, model, 0.3);
  return {body, config, onlyAlong(0, *body)};
}

template <typename Case>
class ViscousPathTest : public testing::Test {};

TYPED_TEST_SUITE(ViscousPathTest, ViscousCases, ElementCaseName);

TYPED_TEST(ViscousPathTest, ReactionOfAUniformStretchIsThatOfOnePoint) {
  constexpr int kDim = TypeParam::kDim;
  const double area = kDim == 2 ? M_PI : 1;  // m^2, of the plates
  for (const std::string model : {"linear", "neo_hookean", "mooney_rivlin"}) {
    const auto body = makeBody(irregularBlock<kDim>(2), TypeParam::kKind, model, 0.3);
    ViscousProblem<kDim> problem(body, kAll, onlyAlong(kDim - 1, *body));
    const Material& material = *body->materials()[0];
    ViscoelasticMemory memory(kAll);
    const double way[][2] = {{-0.1, 0.05}, {-0.3, 1}, {-0.3, 0.2}, {-0.05, 0.01}, {0.2, 3}};  // m, s
    for (const auto& [height, duration] : way) {
      Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
      F(2, 2) += height;
      const ViscoelasticStep step(material, kAll, duration);
      const Eigen::Matrix3d stress = material.stress(F) + step.stress(memory, material.kinematics(F));
      step.accept(material.kinematics(F), memory);
      const double expected = area * stress(2, 2);
      EXPECT_NEAR(problem.reaction({0, 0, height}, duration)[2], expected, 1e-6 * std::abs(expected)) << model;
    }
  }
}

TYPED_TEST(ViscousPathTest, AClosedCycleDissipatesUnlessItTakesForever) {
  constexpr int kDim = TypeParam::kDim;
  const auto body = makeBody(irregularBlock<kDim>(2), TypeParam::kKind, "neo_hookean", 0.4);
  constexpr int kSteps = 20;
  const auto work = [&](double duration, double& longest) {
    ViscousProblem<kDim> problem(body, kAll, betweenPlates(*body));
    double sum = 0, force = 0, height = 0;
    for (int i = 1; i <= kSteps; ++i) {
      const double next = -0.2 * (i <= kSteps / 2 ? i : kSteps - i) / (kSteps / 2);
      const double now = problem.reaction({0, 0, next}, duration / kSteps)[2];
      sum += 0.5 * (force + now) * (next - height);
      force = now;
      height = next;
      if (i == kSteps / 2) longest = sum;
    }
    return sum;
  };
  double stored = 0, loaded = 0;
  const double elastic = work(kForever, stored), viscous = work(1, loaded);
  EXPECT_LT(std::abs(elastic), 1e-6 * stored);
  EXPECT_GT(viscous, 0.1 * stored);
  EXPECT_GT(loaded, 1.1 * stored);
}

// Simple shear changes no volume: all of the stress relaxes. The unit cube's reaction is the stress, Pa m^2.

TEST(ViscousPath, ReactionOfASuddenShearRelaxesAsThePronySeries) {
  const double mu = Lame::from(kYoungModulus, 0.3).mu, shear = 0.3;
  for (const std::string model : {"linear", "neo_hookean"}) {  // stress mu times shear at any shear
    ViscousProblem<3> problem = simpleShear(model, kProny);
    const double elastic = mu * shear;
    EXPECT_NEAR(problem.reaction({shear, 0, 0}, 1e-9)[0], (1 + relaxation(0)) * elastic, 1e-7 * elastic) << model;
    double time = 0;
    for (const double hold : {0.03, 0.07, 0.4, 1.5, 4.0, 100.0}) {
      time += hold;
      EXPECT_NEAR(problem.reaction({shear, 0, 0}, hold)[0], (1 + relaxation(time)) * elastic, 1e-7 * elastic) << time;
    }
  }
}

TEST(ViscousPath, ReactionOfALinearRampIsExact) {
  // Each branch carries beta mu v tau (1 - exp(-t/tau)), whatever the load steps.
  const double mu = Lame::from(kYoungModulus, 0.3).mu, speed = 0.1;
  ViscousProblem<3> problem = simpleShear("linear", kProny);
  double time = 0;
  for (const double duration : {0.01, 0.5, 0.05, 3.0}) {
    time += duration;
    const double branches = 0.8 * 0.1 * -std::expm1(-time / 0.1) + 1.5 * 2 * -std::expm1(-time / 2);
    const double expected = mu * speed * (time + branches);
    EXPECT_NEAR(problem.reaction({speed * time, 0, 0}, duration)[0], expected, 1e-7 * expected);
  }
}

TEST(ViscousPath, ASlowRampIsElastic) {
  const double mu = Lame::from(kYoungModulus, 0.3).mu, shear = 0.3;
  for (const std::string model : {"linear", "neo_hookean"}) {
    EXPECT_NEAR(simpleShear(model, kAll).reaction({shear, 0, 0}, 1e9)[0], mu * shear, 1e-7 * mu * shear) << model;
    EXPECT_NEAR(simpleShear(model, kAll).reaction({shear, 0, 0}, kForever)[0], mu * shear, 1e-7 * mu * shear) << model;
  }
}

TEST(ViscousPath, AViscositysForceIsProportionalToTheSpeed) {
  const double mu = Lame::from(kYoungModulus, 0.3).mu, viscosity = 0.3, shear = 0.2;
  for (const double speed : {0.01, 1.0, 50.0}) {
    ViscousProblem<3> problem = simpleShear("linear", {{}, viscosity});
    const double expected = mu * shear + viscosity * speed;
    EXPECT_NEAR(problem.reaction({shear, 0, 0}, shear / speed)[0], expected, 1e-7 * expected);
    EXPECT_NEAR(problem.reaction({shear, 0, 0}, 1)[0], mu * shear, 1e-7 * expected);  // at rest
  }
}

TEST(ViscousPath, ALoadPathsOwnStepsAddUpToTheDuration) {
  // The same ramp at once and in the path's ten steps, of a linear material: no difference.
  const auto body = makeBody(irregularBlock<3>(2), ElementKind::kP2, "linear", 0.3);
  const Eigen::Vector3d target(0.1, 0, -0.2);
  ViscousProblem<3> whole(body, kProny, onlyAlong(0, *body)), pieces(body, kProny, onlyAlong(0, *body), 0.023);
  const Eigen::Vector3d expected = whole.reaction(target, 0.5);
  EXPECT_LT((pieces.reaction(target, 0.5) - expected).norm(), 1e-7 * expected.norm());
}

TEST(ViscousPath, ForceOfAnIncompressibleBodyRelaxesAsThePronySeries) {
  // The pressure adapts, so that the whole force does; lambda / mu = 5000 leaves a difference of some 1e-3.
  const auto body = makeBody(irregularBlock<2>(3), ElementKind::kP2P0, "linear", 0.4999);
  const Eigen::Vector3d target(0, 0, -0.01);
  ViscousProblem<2> elastic(body, {}, betweenPlates(*body)), problem(body, kProny, betweenPlates(*body));
  const double longterm = elastic.reaction(target, kForever)[2];
  EXPECT_NEAR(problem.reaction(target, 1e-9)[2] / longterm, 1 + relaxation(0), 5e-3);
  EXPECT_NEAR(problem.reaction(target, 0.1)[2] / longterm, 1 + relaxation(0.1), 5e-3);
  EXPECT_NEAR(problem.reaction(target, 2)[2] / longterm, 1 + relaxation(2.1), 5e-3);
  EXPECT_NEAR(problem.reaction(target, 100)[2] / longterm, 1, 1e-4);
}

TEST(ViscousPath, ResetIsANewBeginning) {
  ViscousProblem<3> problem = simpleShear("neo_hookean", kAll);
  const double first = problem.reaction({0.3, 0, 0}, 0.1)[0];
  problem.path.reset();
  EXPECT_EQ(problem.reaction({0.3, 0, 0}, 0.1)[0], first);
}

}  // namespace
}  // namespace microinjection
