#include "cell/model/solved_branch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>

#include "base/errors.h"
#include "cell/model/pierced_cell.h"
#include "cell/penetration/hole_expansion.h"

namespace microinjection {
namespace {

/// A sphere of 18 um under a tip of 3 um.
Scene softScene() {
  Scene scene;
  scene.cell.layers[0].outer_radius = 18e-6;
  scene.cell.material().model = "neo_hookean";
  scene.cell.material().young_modulus = 2.98e3;
  scene.cell.material().poisson_ratio = 0.49;
  scene.needle.tip = {"hemisphere", 3e-6, 0};
  scene.holding_pipette.contact_radius = 9e-6;
  scene.cell.puncture.layers.emplace_back().toughness = 1e3 * 3e-6;  // J / (mu R) = 1
  return scene;
}

TEST(SolvedBranch, TheHoleGrowsAtTheForceOfSteadyPenetration) {
  const Scene scene = softScene();
  int paths = 0;
  const PiercedBranch branch = solvePiercedBranch(scene, -1, [&](int path, int) { paths = path; });
  EXPECT_GE(paths, 6);
  ASSERT_TRUE(branch.onset());
  const double steady = steadyPenetration(scene).force_in * 9e-12;
  const PiercedBranch::Onset onset = *branch.onset();
  EXPECT_GT(onset.force, 1.2 * steady);
  const double depth = onset.depth + 6e-6, length = branch.grown(depth, onset.length);
  EXPECT_GT(length, 8e-6);
  EXPECT_NEAR(branch.at(depth, length).force, steady, 0.03 * steady);
}

PiercedCellConfig pierced(double radius, double held_radius, double hole_radius, double hole_length) {
  PiercedCellConfig config;
  config.material = softScene().cell.material();
  config.radius = radius;
  config.held_radius = held_radius;
  config.tip_radius = 3e-6;
  config.hole_radius = hole_radius;
  config.hole_length = hole_length;
  config.level = -0.5;
  return config;
}

TEST(PiercedCell, ANeedleInItsHoleFeelsWhatOpensIt) {
  const PiercedCellConfig config = pierced(30e-6, 9e-6, 1.5e-6, 15e-6);
  PiercedCell cell(config);
  ASSERT_TRUE(cell.insert(0)) << cell.reason();
  ASSERT_TRUE(cell.advance(6e-6)) << cell.reason();
  const double before = cell.energy();
  ASSERT_TRUE(cell.advance(9e-6)) << cell.reason();
  const auto material = makeMaterial(config.material);
  const double opened = HoleExpansion(*material, 10).at(0.5).energy * 9e-12;
  EXPECT_NEAR(cell.force(), opened, 0.03 * opened);
  EXPECT_NEAR(cell.energy() - before, opened * 3e-6, 0.03 * opened * 3e-6);
  EXPECT_LT(cell.penetration(), 0.02 * config.tip_radius);
}

/// Opening the hole costs more than denting the cell below it by ten tip radii would.
TEST(PiercedCell, ANeedleStaysInASmallHoleOfAMaterialThatStiffens) {
  PiercedCellConfig config = pierced(28e-6, 10e-6, 0.95e-6, 18e-6);
  config.material.model = "ogden";
  config.material.ogden_exponent = 8;
  PiercedCell cell(config);
  ASSERT_TRUE(cell.insert(0)) << cell.reason();
  EXPECT_TRUE(cell.isInside());
  const auto material = makeMaterial(config.material);
  const double opened = HoleExpansion(*material, config.radius / config.tip_radius).at(0.95 / 3).energy * 9e-12;
  EXPECT_GT(cell.force(), opened);
  ASSERT_TRUE(cell.advanceAcross(26e-6)) << cell.reason();
  EXPECT_TRUE(cell.isInside());
  EXPECT_NEAR(cell.force(), opened, 0.05 * opened);
}

TEST(SteadyPenetration, RefusesWhatItCannotPierce) {
  const auto refusal = [](const std::function<void(Scene&)>& change) {
    Scene scene = softScene();
    change(scene);
    try {
      steadyPenetration(scene);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refusal([](Scene&) {}), "");
  EXPECT_NE(refusal([](Scene& scene) {
              scene.needle.tip = {"disc", 3e-6, 0};
            }).find("needle/tip/shape"),
            std::string::npos);
  EXPECT_NE(refusal([](Scene& scene) { scene.cell.material().model = "linear"; }).find("linear"), std::string::npos);
  EXPECT_NE(refusal([](Scene& scene) { scene.cell.layers[0].surface_tension = 1e-4; }).find("homogeneous"),
            std::string::npos);
  const std::string brittle = refusal([](Scene& scene) { scene.cell.puncture.layers[0].toughness = 0.3; });
  EXPECT_NE(brittle.find("smaller toughness"), std::string::npos) << brittle;
  const std::string weak = refusal([](Scene& scene) { scene.cell.puncture.layers[0].toughness = 1e-6; });
  EXPECT_NE(weak.find("a larger toughness"), std::string::npos) << weak;
}

}  // namespace
}  // namespace microinjection
