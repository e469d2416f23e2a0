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

/// A shell of 2.5 tip radii over a softer inside.
TEST(SolvedBranch, AShellIsPiercedAndThenItsInside) {
  Scene scene = softScene();
  scene.cell.layers.push_back(scene.cell.layers.front());
  scene.cell.layers[1].name = "inside";
  scene.cell.layers[1].outer_radius = 10.5e-6;
  scene.cell.layers[1].material.young_modulus /= 4;
  scene.cell.layers[1].surface_tension = 1e-5;
  scene.cell.puncture.layers.emplace_back().toughness = 0.6e-3;
  const PiercedBranch branch = solvePiercedBranch(scene, -1.5);
  ASSERT_TRUE(branch.onset());
  ASSERT_EQ(branch.crack().parts.size(), 2u);
  EXPECT_NEAR(branch.crack().parts[1].from, 7.5e-6, 1e-12);
  EXPECT_NEAR(branch.crack().parts[1].cost, 0.2 * branch.crack().parts[0].cost, 1e-9 * branch.crack().parts[0].cost);
  EXPECT_LT(branch.onset()->length, 7.5e-6) << "the first hole ends in the shell";
  double length = branch.onset()->length, depth = branch.onset()->depth, in_shell = 0;
  for (; length < 11e-6; length = branch.grown(depth += 0.2e-6, length)) {
    if (length < 7.5e-6) in_shell = branch.at(depth, length).force;
  }
  EXPECT_GT(in_shell, 2 * branch.at(depth, length).force);
  EXPECT_LT(distanceFromLongHole(branch, scene).value(), 0.05);
}

/// 0.09 tip radii, at the traction's peak, are nearly as much as this hole may have.
TEST(SolvedBranch, AMaterialWithAStrengthGivesWayWhereThatIsExceeded) {
  Scene scene = softScene();
  scene.needle.contact.mode = "sliding";
  PunctureConfig::Layer& layer = scene.cell.puncture.layers.front();
  layer.strength = layer.toughness / (M_E * 0.09 * 3e-6);
  const PiercedBranch branch = solvePiercedBranch(scene, -1.5);
  ASSERT_TRUE(branch.onset());
  EXPECT_GT(branch.crack().gives_way, 3e-6);
  EXPECT_EQ(branch.onset()->depth, branch.crack().gives_way);
  EXPECT_LT(branch.onset()->pierced_force, 0.8 * branch.onset()->force);
}

PiercedCellConfig pierced(double radius, double held_radius, double hole_radius, double hole_length) {
  PiercedCellConfig config;
  config.layers = softScene().cell.layers;
  config.layers.front().outer_radius = radius;
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
  const auto material = makeMaterial(config.material());
  const double opened = HoleExpansion(*material, 10).at(0.5).energy * 9e-12;
  EXPECT_NEAR(cell.force(), opened, 0.03 * opened);
  EXPECT_NEAR(cell.energy() - before, opened * 3e-6, 0.03 * opened * 3e-6);
  EXPECT_LT(cell.penetration(), 0.02 * config.tip_radius);
}

/// Opening the hole costs more than denting the cell below it by ten tip radii would.
TEST(PiercedCell, ANeedleStaysInASmallHoleOfAMaterialThatStiffens) {
  PiercedCellConfig config = pierced(28e-6, 10e-6, 0.95e-6, 18e-6);
  config.material().model = "ogden";
  config.material().ogden_exponent = 8;
  PiercedCell cell(config);
  ASSERT_TRUE(cell.insert(0)) << cell.reason();
  EXPECT_TRUE(cell.isInside());
  const auto material = makeMaterial(config.material());
  const double opened = HoleExpansion(*material, config.radius() / config.tip_radius).at(0.95 / 3).energy * 9e-12;
  EXPECT_GT(cell.force(), opened);
  ASSERT_TRUE(cell.advanceAcross(26e-6)) << cell.reason();
  EXPECT_TRUE(cell.isInside());
  EXPECT_NEAR(cell.force(), opened, 0.05 * opened);
}

/// 2.07 tip radii and 2.41 pi R^2 mu are those of a second solver, of GetFEM:
/// benchmark/peers/getfem_puncture.py, cell A of doc/reference/benchmarks.md, Puncture by mechanics.
TEST(PiercedCell, AWallThatIsHeldClosedGivesWayWhereASecondSolverHasIt) {
  PiercedCellConfig config = pierced(30e-6, 9e-6, 0.534 * 3e-6, 39e-6);
  config.cohesion = PiercedCellConfig::Cohesion{3e-3, 0.08 * 3e-6};  // J / (mu R) = 1
  PiercedCell cell(config);
  double depth = 0, force = 0;
  while (cell.advance(depth + 0.3e-6)) {
    depth = cell.depth();
    force = cell.force();
    ASSERT_LT(depth, 9e-6);
  }
  EXPECT_NEAR(cell.depth() / 3e-6, 2.07, 0.02 * 2.07);
  EXPECT_NEAR(cell.force() / (M_PI * 9e-12 * 1e3), 2.41, 0.02 * 2.41);
  EXPECT_GE(cell.force(), force);
}

/// Of a tense surface the hole takes a part away, and the force is the slope of what is left.
TEST(PiercedCell, OfATenseCellTheForceIsTheSlopeOfTheEnergy) {
  PiercedCellConfig config = pierced(30e-6, 9e-6, 1.5e-6, 9e-6);
  config.layers.front().surface_tension = 2e-4;  // N/m
  PiercedCell cell(config);
  EXPECT_LT(cell.energy(), -2e-4 * M_PI * 2.25e-12) << "the surface over the hole is gone, and the rim gives way";
  ASSERT_TRUE(cell.insert(0)) << cell.reason();
  const double shallow = cell.depth() + 0.5e-6, step = 0.1e-6;
  ASSERT_TRUE(cell.advance(shallow)) << cell.reason();
  const double energy = cell.energy();
  double last = cell.force(), work = 0;
  for (int i = 1; i <= 10; ++i) {
    ASSERT_TRUE(cell.advance(shallow + i * step)) << cell.reason();
    work += step * (last + cell.force()) / 2;
    last = cell.force();
  }
  EXPECT_NEAR(cell.energy() - energy, work, 2e-3 * work);
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
  EXPECT_NE(refusal([](Scene& scene) {
              scene.cell.puncture.layers.push_back(scene.cell.puncture.layers.front());
            }).find("2 have a toughness, but the cell has 1 layers"),
            std::string::npos);
  const std::string sticky = refusal([](Scene& scene) { scene.cell.puncture.layers[0].strength = 4e3; });
  EXPECT_NE(sticky.find("sliding"), std::string::npos) << sticky;
  const std::string brittle_wall = refusal([](Scene& scene) {
    scene.needle.contact.mode = "sliding";
    scene.cell.puncture.layers[0].strength = 4e5;
  });
  EXPECT_NE(brittle_wall.find("3925.5 to 12262.6 Pa"), std::string::npos) << brittle_wall;
  const std::string brittle = refusal([](Scene& scene) { scene.cell.puncture.layers[0].toughness = 0.3; });
  EXPECT_NE(brittle.find("smaller toughness"), std::string::npos) << brittle;
  const std::string weak = refusal([](Scene& scene) { scene.cell.puncture.layers[0].toughness = 1e-6; });
  EXPECT_NE(weak.find("a larger toughness"), std::string::npos) << weak;
}

}  // namespace
}  // namespace microinjection
