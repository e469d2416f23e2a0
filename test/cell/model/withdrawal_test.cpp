// The needle is drawn back: adhesion pulls it, as theory has it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "cell/model/cell_problem.h"
#include "cell/model/converged_force.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

Scene adhesiveScene() {
  Scene scene;
  scene.cell.material().model = "neo_hookean";
  scene.needle.tip.shape = "hemisphere";
  scene.needle.contact.mode = "sliding";
  scene.needle.contact.adhesion_energy = 2e-3;
  scene.needle.contact.adhesion_range = 0.5e-6;
  return scene;
}

/// Between the limits for soft bodies and forces of no range (Johnson, Kendall, Roberts 1971: 3/2 pi w R) and for rigid
/// ones (Derjaguin, Muller, Toporov 1975: 2 pi w R), whatever the cell's modulus and the range.
TEST(Withdrawal, PullOffLiesBetweenItsLimits) {
  const Scene scene = adhesiveScene();
  const double radius = 1 / (1 / scene.needle.tip.radius + 1 / scene.radius());
  const double unit = M_PI * scene.needle.contact.adhesion_energy * radius;  // N
  CellProblem<2> problem(scene, makeSceneMesh<2>(scene, 0), ElementKind::kP2P0);
  const auto force = [&](double depth) {
    const IndentationSolution solution = problem.solve({0, 0, -depth});
    EXPECT_TRUE(solution.converged) << depth << ": " << solution.reason;
    return solution.force.z();
  };
  EXPECT_GT(force(4e-6), 0);  // wide enough that all that is in reach has touched
  double pull = 0;
  for (double depth = 0; depth > -1e-6; depth -= 0.1e-6) pull = std::max(pull, -force(depth));
  EXPECT_GT(pull, 1.4 * unit);  // the range is not small against the tip
  EXPECT_LT(pull, 2 * unit);
  EXPECT_NEAR(force(-12e-6), 0, 1e-4 * unit);   // torn off
  EXPECT_NEAR(force(-0.3e-6), 0, 1e-4 * unit);  // and forgotten, until it touches again
}

TEST(Withdrawal, IsCheckedAndFollowsTheWayIn) {
  Scene scene = adhesiveScene();
  scene.needle.contact.adhesion_energy = 0;
  Indenting indenting;
  indenting.depths = {1e-6};
  indenting.withdrawal = {0.5e-6, -0.5e-6};
  const std::vector<ForcePoint> points = ConvergedForce(scene, indenting, {}).solve();
  ASSERT_EQ(points.size(), 3u);
  EXPECT_EQ(points[1].depth, 0.5e-6);
  EXPECT_GT(points[0].force.z(), points[1].force.z());
  EXPECT_GT(points[1].force.z(), 0);
  EXPECT_EQ(points[2].force.z(), 0);  // a smooth tip without adhesion has nothing to hold on to
  EXPECT_TRUE(points[2].converged);
  indenting.withdrawal = {1e-6};
  EXPECT_THROW(ConvergedForce(scene, indenting, {}), ConfigError);
  indenting.withdrawal = {0.5e-6};
  indenting.lateral = {1e-6, 0};
  EXPECT_THROW(ConvergedForce(scene, indenting, {}), ConfigError);
}

}  // namespace
}  // namespace microinjection
