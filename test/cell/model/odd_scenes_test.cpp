// Legal scenes that have once given a wrong force in silence.

#include <gtest/gtest.h>

#include <vector>

#include "cell/mesh/cell_mesher.h"
#include "cell/model/cell_problem.h"
#include "cell/model/converged_force.h"
#include "cell/model/scene_mesh.h"
#include "cell/model/test_scenes.h"

namespace microinjection {
namespace {

std::vector<ForcePoint> pushAlong(const Scene& scene, const Indenting& indenting, double tolerance = 0.05) {
  ConvergedForceConfig config;
  config.tolerance = tolerance;
  return ConvergedForce(scene, indenting, config).solve();
}

/// The dashpot resists in every step, also where points come into contact; and what sticks resists more than what
/// slides.
TEST(OddScenes, ViscousForceUnderARoundedTipGrowsWithDepth) {
  Scene sticking = pipetteScene("sticking"), sliding = pipetteScene("sliding");
  sticking.cell.material().viscoelasticity.viscosity = sliding.cell.material().viscoelasticity.viscosity = 20e3;
  Indenting indenting;
  indenting.depths = {0.5e-6, 1e-6, 1.5e-6, 2e-6, 2.5e-6, 3e-6};
  indenting.speed = 1e-6;
  const auto stuck = pushAlong(sticking, indenting), slid = pushAlong(sliding, indenting);
  for (std::size_t i = 0; i < stuck.size(); ++i) {
    ASSERT_TRUE(stuck[i].converged && slid[i].converged) << stuck[i].reason << slid[i].reason;
    EXPECT_GT(stuck[i].force.z(), 0.99 * slid[i].force.z()) << stuck[i].depth;
    if (i > 0) EXPECT_GT(stuck[i].force.z(), 1.1 * stuck[i - 1].force.z()) << stuck[i].depth;
  }
}

/// A Prony branch that does not relax in the time is elastic: the same cell with other constants.
TEST(OddScenes, TheContactIsStiffForTheInstantaneousModulus) {
  Scene viscous = pipetteScene("sliding"), elastic = viscous;
  viscous.cell.material() = {"linear", 17.9e3, 0.49};
  viscous.cell.material().viscoelasticity.prony = {{99, 1e6}};
  const double mu = 100 * 17.9e3 / (2 * 1.49), lambda = 17.9e3 * 0.49 / (1.49 * 0.02);
  elastic.cell.material() = {"linear", mu * (3 * lambda + 2 * mu) / (lambda + mu), lambda / (2 * (lambda + mu))};
  Indenting indenting;
  indenting.depths = {1e-6};
  const double expected = pushAlong(elastic, indenting, 0.01)[0].force.z();
  indenting.speed = 1;
  EXPECT_NEAR(pushAlong(viscous, indenting, 0.01)[0].force.z() / expected, 1, 0.01);
}

TEST(OddScenes, ALargeDiscSticksAlsoBesideTheAxis) {
  Scene scene;
  scene.cell.layers.front().outer_radius = 10e-6;
  scene.cell.material() = {"linear", 17.9e3, 0.49};
  scene.needle.tip.radius = 7e-6;
  scene.holding_pipette.contact_radius = 4e-6;
  Indenting indenting;
  indenting.depths = {0.5e-6};
  const double on_axis = pushAlong(scene, indenting, 0.005)[0].force.z();
  scene.needle.offset = {1e-9, 0};
  EXPECT_NEAR(pushAlong(scene, indenting, 0.03)[0].force.z() / on_axis, 1, 0.03);
}

TEST(OddScenes, ADepthThatIsRepeatedHasTheSameForce) {
  Scene scene;
  scene.cell.material().viscoelasticity.prony = {{1, 1}};
  Indenting once, twice;
  once.depths = {1e-6, 2e-6};
  twice.depths = {1e-6, 1e-6, 2e-6};
  once.speed = twice.speed = 5e-6;
  const auto a = pushAlong(scene, once), b = pushAlong(scene, twice);
  EXPECT_EQ(a[0].force, b[0].force);
  EXPECT_EQ(b[0].force, b[1].force);
  EXPECT_EQ(a[1].force, b[2].force);
}

TEST(OddScenes, AContactBetweenTheMeshsPointsIsNoForceOfZero) {
  Indenting indenting;
  indenting.depths = {1e-11};
  const ForcePoint point = pushAlong(pipetteScene("sticking"), indenting)[0];
  EXPECT_FALSE(point.converged);
  EXPECT_NE(point.reason.find("the contact is smaller"), std::string::npos) << point.reason;
}

TEST(OddScenes, AuxeticCellsHaveAForce) {
  Scene scene;
  scene.cell.material() = {"linear", 17.9e3, -0.3};
  Indenting indenting;
  indenting.depths = {1e-6};
  ConvergedForceConfig other;
  other.element = ElementKind::kP2;  // no locking there
  other.tolerance = 0.01;
  const double expected = ConvergedForce(scene, indenting, other).solve()[0].force.z();
  EXPECT_NEAR(pushAlong(scene, indenting, 0.01)[0].force.z() / expected, 1, 0.02);
}

/// Where the path ends, what is left is an equilibrium: found once more from nothing, it has the same force.
TEST(OddScenes, PastTheEndTheLastEquilibriumStays) {
  const Scene scene = pipetteScene("sticking");
  CellProblem<2> problem(scene, makeSceneMesh<2>(scene, -1), ElementKind::kP2P0);
  CellProblem<2> again(scene, makeSceneMesh<2>(scene, -1), ElementKind::kP2P0);
  const IndentationSolution end = problem.solve({0, 0, -55e-6});
  ASSERT_FALSE(end.converged);
  ASSERT_GT(-end.tip_displacement.z(), 30e-6);
  const IndentationSolution there = again.solve(end.tip_displacement);
  if (there.converged) EXPECT_NEAR(end.force.z() / there.force.z(), 1, 0.01);
  EXPECT_GT(end.force.z(), 4e-6);
}

/// Both components against another mesh (unstructured, of gmsh) and another element.
TEST(OddScenes, OffTheAxisForceIsThatOfAnUnstructuredMesh) {
  Scene scene;
  scene.cell.material() = {"linear", 17.9e3, 0.49};
  scene.needle.offset = {10e-6, 0};
  Indenting indenting;
  indenting.depths = {1e-6};
  const ForcePoint point = pushAlong(scene, indenting, 0.03)[0];
  CellMeshConfig mesh;
  const double radius = scene.needle.tip.radius, holding = scene.holding_pipette.contact_radius;
  mesh.radii = {scene.radius()};
  mesh.size = 7e-6;
  mesh.growth = 0.35;
  mesh.imprints = {{scene.needle.offset, radius, +1}, {Eigen::Vector2d::Zero(), holding, -1}};
  mesh.refinements = {{CellMeshConfig::Shape::kCircle, scene.needle.offset, radius, +1, 0.7e-6},
                      {CellMeshConfig::Shape::kCircle, Eigen::Vector2d::Zero(), holding, -1, 3e-6}};
  CellProblem<3> other(scene, makeQuadratic(makeCellMesh(mesh), mesh.radii), ElementKind::kP2P0);
  const Eigen::Vector3d expected = other.solve({0, 0, -1e-6}).force;
  EXPECT_NEAR(point.force.z() / expected.z(), 1, 0.05);
  EXPECT_NEAR(point.force.x() / expected.x(), 1, 0.05);
}

}  // namespace
}  // namespace microinjection
