#include "cell/estimation/puncture_prediction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cell/estimation/family_member.h"
#include "cell/family/family_cell.h"
#include "cell/surrogate/surrogate_contact.h"

namespace microinjection {
namespace {

constexpr double kModulus = 17.9e3, kForce = 1.5e-6;  // Pa, N, of kInjectedCell

/// Depth (m) and force (N) at which this cell fails when a tip goes down in steps of 10 nm.
std::pair<double, double> puncture(const Scene& scene) {
  SurrogateContact contact(scene, memberOf(scene));
  for (double depth = 0; depth < scene.radius(); depth += 10e-9) {
    const double force = contact.step({0, 0, scene.radius() - depth}).force.z();
    if (scene.cell.puncture.layers[0].fails(force, depth, scene.needle.tip.radius)) return {depth, force};
  }
  return {0, 0};
}

TEST(PuncturePrediction, OfAKnownCellIsWhereItFails) {
  for (const char* law : {"force", "depth", "strain"}) {
    Scene scene = loadScene(kInjectedCell);
    PunctureConfig::Layer& layer = scene.cell.puncture.layers[0];
    if (law[0] != 'f') layer.force = std::numeric_limits<double>::infinity();
    if (law[0] == 'd') layer.depth = 9e-6;
    if (law[0] == 's') {
      layer.strain = 0.15;
      layer.dimple_radius = 20e-6;
    }
    const auto [depth, force] = puncture(scene);
    const auto predicted = PuncturePredictor(scene, memberOf(scene), 1e-6).predict(kModulus, 1e-6, 0);
    ASSERT_TRUE(predicted) << law;
    EXPECT_NEAR(predicted->depth, depth, 0.05e-6) << law;
    EXPECT_NEAR(predicted->force / force, 1, 0.01) << law;
    EXPECT_EQ(predicted->beyond, 0);
  }
}

TEST(PuncturePrediction, AStifferCellFailsEarlierByForceAndHarderByDepth) {
  Scene scene = loadScene(kInjectedCell);
  const auto soft = PuncturePredictor(scene, memberOf(scene), 0.1).predict(kModulus, 0.02, 0);
  const auto stiff = PuncturePredictor(scene, memberOf(scene), 0.1).predict(2 * kModulus, 0.02, 0);
  EXPECT_LT(stiff->depth, soft->depth);
  EXPECT_NEAR(stiff->force / soft->force, 1, 0.02);
  scene.cell.puncture.layers[0].force = std::numeric_limits<double>::infinity();
  scene.cell.puncture.layers[0].depth = 9e-6;
  const auto soft_depth = PuncturePredictor(scene, memberOf(scene), 0.1).predict(kModulus, 0.02, 0);
  const auto stiff_depth = PuncturePredictor(scene, memberOf(scene), 0.1).predict(2 * kModulus, 0.02, 0);
  EXPECT_NEAR(stiff_depth->depth / soft_depth->depth, 1, 0.02);
  EXPECT_NEAR(stiff_depth->force / soft_depth->force, 2, 0.05);
}

TEST(PuncturePrediction, ACellThatHasNotFailedYetIsStrongerThanExpected) {
  const Scene scene = loadScene(kInjectedCell);
  const PuncturePredictor predictor(scene, memberOf(scene), 0.2);
  const auto before = predictor.predict(kModulus, 0.02, 0);
  const auto later = predictor.predict(kModulus, 0.02, before->depth);
  ASSERT_TRUE(later);
  EXPECT_GT(later->depth_low, before->depth);
  EXPECT_GT(later->force, before->force);
  EXPECT_FALSE(predictor.predict(kModulus, 0.02, 3 * before->depth));
}

TEST(PuncturePrediction, IntervalsCover) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  int depths = 0, forces = 0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    Scene scene = loadScene(kInjectedCell);
    const PuncturePredictor predictor(scene, memberOf(scene), 0.15);
    const double known = kModulus * std::exp(0.05 * normal(random));  // an estimate of 5 %
    scene.cell.puncture.layers[0].force *= std::exp(0.15 * normal(random));
    const auto [depth, force] = puncture(scene);
    const auto predicted = predictor.predict(known, 0.05, 0.5 * depth);
    ASSERT_TRUE(predicted);
    depths += predicted->depth_low <= depth && depth <= predicted->depth_high;
    forces += predicted->force_low <= force && force <= predicted->force_high;
  }
  // 95 %: fewer than 52 of 60 have a probability below 1 %.
  EXPECT_GE(depths, 52);
  EXPECT_GE(forces, 52);
}

TEST(PuncturePrediction, ACellWithoutAFailureLawHasNone) {
  Scene scene = loadScene(kInjectedCell);
  scene.cell.puncture.layers.clear();
  EXPECT_FALSE(PuncturePredictor(scene, memberOf(scene), 0.1).predict(kModulus, 0.1, 0));
}

}  // namespace
}  // namespace microinjection
