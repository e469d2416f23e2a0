#include "cell/tensegrity/tensegrity_loading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cell/tensegrity/bundles.h"

namespace microinjection {
namespace {

/// The force under the needle is the derivative of its work, and the stiffness that of the force.
TEST(TensegrityLoading, ForceAndStiffnessBelongTogether) {
  const auto structure = make(bundles());
  TensegrityLoading loading(structure, {structure->endNode(topEnd(structure->geometry()))});
  ASSERT_TRUE(loading.advance({0, 0, -1e-6}).converged);
  const Eigen::Matrix3d stiffness = loading.stiffness();
  const double step = 1e-9;
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector3d way = Eigen::Vector3d::Unit(k) * step, at(0, 0, -1e-6);
    ASSERT_TRUE(loading.advance(at + way).converged);
    const Eigen::Vector3d ahead = loading.force();
    ASSERT_TRUE(loading.advance(at - way).converged);
    const Eigen::Vector3d slope = (ahead - loading.force()) / (2 * step);
    EXPECT_LT((slope + stiffness.col(k)).norm(), 1e-4 * stiffness.norm());
  }
}

/// The expanded octahedron of actin cables alone has one mechanism, stiff to first order by prestress only: its
/// stiffness rises with the prestress (Fig. 12), where that of a structure of springs without would stay.
TEST(TensegrityLoading, StiffensWithPrestress) {
  double last = 0;
  for (const double prestrain : {0.0, 0.05, 0.2}) {
    const auto structure = make(bundles(prestrain));
    TensegrityLoading loading(structure, {structure->endNode(topEnd(structure->geometry()))});
    ASSERT_TRUE(loading.advance({0, 0, -2e-6}).converged);
    EXPECT_GT(loading.force().z(), 1.2 * last) << prestrain;
    last = loading.force().z();
  }
}

TEST(TensegrityLoading, SlackCablesPullNothingAndAreTakenUpAgain) {
  const auto structure = make(bundles());
  TensegrityLoading loading(structure, {structure->endNode(topEnd(structure->geometry()))});
  const auto slack = [&] {
    int count = 0;
    for (int i = 0; i < loading.cables().elementCount(); ++i) {
      const double tension = loading.cables().tension(i, loading.state());
      EXPECT_GE(tension, 0);
      count += tension == 0;
    }
    return count;
  };
  EXPECT_EQ(slack(), 0);
  ASSERT_TRUE(loading.advance({0, 0, -6e-6}).converged);
  EXPECT_GT(slack(), 0);
  ASSERT_TRUE(loading.advance(Eigen::Vector3d::Zero()).converged);
  EXPECT_EQ(slack(), 0);
  EXPECT_LT(loading.force().norm(), 1e-6 * structure->form().prestress);  // elastic: back where it was
  loading.reset();
  EXPECT_LT(loading.force().norm(), 1e-8 * structure->form().prestress);
}

/// Linear tetrahedra take a rotation for a strain, so that struts grow as they turn; the others do not.
TEST(TensegrityLoading, LinearStrutsTakeRotationForStrain) {
  double forces[3];
  for (int i = 0; i < 3; ++i) {
    TensegrityConfig config = bundles();
    config.microtubules.model = strutModels()[i];  // linear, st_venant_kirchhoff, corotated
    const auto structure = make(config);
    TensegrityLoading loading(structure, {structure->endNode(topEnd(structure->geometry()))});
    ASSERT_TRUE(loading.advance({0, 0, -8e-6}).converged);
    forces[i] = loading.force().z();
  }
  EXPECT_NEAR(forces[1] / forces[2], 1, 0.01);
  EXPECT_GT(std::abs(forces[0] / forces[2] - 1), 0.05);
}

/// Viscous cables resist a fast needle more, a slow one not, and relax to the elastic force when it rests.
TEST(TensegrityLoading, KelvinVoigtResistsFastNeedles) {
  TensegrityConfig config = bundles();
  const auto elastic = make(config);
  config.actin.retardation_time = config.intermediate.retardation_time = 0.5;
  config.membrane.retardation_time = 0.5;
  const auto viscous = make(config);
  const int end = topEnd(elastic->geometry());
  const Eigen::Vector3d way(0, 0, -1e-6);
  TensegrityLoading reference(elastic, {elastic->endNode(end)}), slow(viscous, {viscous->endNode(end)}),
      fast(viscous, {viscous->endNode(end)});
  ASSERT_TRUE(reference.advance(way, 0.1).converged);
  ASSERT_TRUE(slow.advance(way, 1e4).converged);
  ASSERT_TRUE(fast.advance(way, 0.1).converged);
  EXPECT_NEAR(slow.force().z() / reference.force().z(), 1, 1e-3);
  EXPECT_GT(fast.force().z(), 1.5 * reference.force().z());
  ASSERT_TRUE(fast.advance(way, 1e4).converged);
  EXPECT_NEAR(fast.force().z() / reference.force().z(), 1, 1e-2);
}

/// Where stable equilibria end (Figure 13; a dent of the membrane turns over, by 1.9 um) it falls in the time of that
/// step, and what is viscous remembers where it fell to: a short wait afterwards moves nothing.
TEST(TensegrityLoading, WhatIsViscousRemembersWhereASnapEnded) {
  constexpr double kRetardation = 0.5, kStep = 0.1e-6;  // s, m
  TensegrityConfig config = bundles();
  config.membrane.divisions = 8;
  config.actin.retardation_time = config.intermediate.retardation_time = kRetardation;
  config.membrane.retardation_time = kRetardation;
  const auto structure = make(config);
  for (const double slow : {2e3, 50.0}) {  // of the retardation time, that a step takes
    TensegrityLoading loading(structure, {structure->endNode(topEnd(structure->geometry()))});
    ASSERT_TRUE(loading.advance({0, 0, -26.25e-6}, 1e6).converged);
    ASSERT_EQ(loading.snaps(), 0);
    Eigen::VectorXd before;
    for (double depth = 26.35e-6; loading.snaps() == 0 && depth < 28e-6; depth += kStep) {
      before = loading.state();
      ASSERT_TRUE(loading.advance({0, 0, -depth}, slow * kRetardation).converged);
    }
    ASSERT_GE(loading.snaps(), 1);
    const Eigen::VectorXd fallen = loading.state();
    const double fall = (fallen - before).lpNorm<Eigen::Infinity>();
    EXPECT_GT(fall, 1e-6) << slow;
    const Eigen::Vector3d place = loading.displacement();
    ASSERT_TRUE(loading.advance(place, 1e-3 * kRetardation).converged);
    EXPECT_LT((loading.state() - fallen).lpNorm<Eigen::Infinity>(), 1e-3 * fall) << slow;
  }
}

/// No tension, no prestress: nothing keeps the membrane smooth, and its rest is not to be found.
TEST(TensegrityLoading, AMembraneWithoutTensionCrumplesAndSaysSo) {
  TensegrityConfig config = bundles(0);
  config.membrane.tension = 0;
  const auto structure = make(config);
  TensegrityLoading loading(structure, {structure->endNode(topEnd(structure->geometry()))});
  const LoadPath::Result result = loading.advance({0, 0, -5e-6});
  EXPECT_FALSE(result.converged);
  EXPECT_NE(result.reason.find("no stable equilibrium was found"), std::string::npos) << result.reason;
  EXPECT_NE(result.reason.find("without tension"), std::string::npos) << result.reason;
  EXPECT_GT(loading.displacement().z(), -5e-6);
}

}  // namespace
}  // namespace microinjection
