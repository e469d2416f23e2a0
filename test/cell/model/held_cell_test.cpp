// Cells that suction holds, in their section.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/errors.h"
#include "cell/mechanics/reference_element.h"
#include "cell/model/cell_problem.h"
#include "cell/model/scene.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

constexpr double kModulus = 5e3;  // Pa

Scene heldScene() {
  Scene scene;
  scene.cell.layers[0].outer_radius = 40e-6;
  scene.cell.material().model = "neo_hookean";
  scene.cell.material().young_modulus = kModulus;
  scene.cell.material().poisson_ratio = 0.49;
  scene.needle.tip.shape = "hemisphere";
  scene.needle.tip.radius = 4e-6;
  Scene::Mouth mouth;
  mouth.inner_radius = 12e-6;
  mouth.outer_radius = 32e-6;
  mouth.edge_radius = 2e-6;
  mouth.pressure = -500;
  mouth.contact.mode = "sliding";
  scene.holding_pipette.mouth = mouth;
  scene.holding_pipette.contact_radius = mouth.inner_radius + mouth.edge_radius;
  return scene;
}

CellProblem<2> problemOf(const Scene& scene, double level = 0) {
  scene.validate();
  return CellProblem<2>(scene, makeSceneMesh<2>(scene, level), ElementKind::kP2P0);
}

TEST(HeldCell, SuctionAndLipAreInBalance) {
  CellProblem<2> problem = problemOf(heldScene());
  double before = 0;
  for (const double pressure : {-5.0, -50.0, -500.0, -1500.0}) {
    ASSERT_TRUE(problem.hold(pressure).converged);
    const HeldCell held = problem.held();
    EXPECT_NEAR(held.pressure, pressure, 1e-9);
    const double force = -pressure * M_PI * held.seal_radius * held.seal_radius;
    EXPECT_NEAR(held.clamping_force, force, 2e-3 * force);
    EXPECT_LT(std::abs(held.imbalance), 2e-4 * force);
    EXPECT_GT(held.tongue_length, before);
    before = held.tongue_length;
  }
}

/// Back at a pressure, the cell is as it was: without friction nothing is lost.
TEST(HeldCell, WithoutFrictionThePathDoesNotMatter) {
  CellProblem<2> problem = problemOf(heldScene());
  ASSERT_TRUE(problem.hold(-300).converged);
  const double first = problem.held().tongue_length;
  ASSERT_TRUE(problem.hold(-1200).converged);
  ASSERT_TRUE(problem.hold(-300).converged);
  EXPECT_NEAR(problem.held().tongue_length, first, 2e-4 * first);
  problem.reset();
  ASSERT_TRUE(problem.hold(-300).converged);
  EXPECT_NEAR(problem.held().tongue_length, first, 1e-9 * first);
}

TEST(HeldCell, AFinerMeshHasTheSameTongue) {
  double tongues[2];
  for (const int level : {0, 1}) {
    CellProblem<2> problem = problemOf(heldScene(), level);
    ASSERT_TRUE(problem.hold(-1000).converged);
    tongues[level] = problem.held().tongue_length;
  }
  EXPECT_NEAR(tongues[0], tongues[1], 0.004 * tongues[1]);
}

/// An incompressible half-space under a flat mouth, L/a = 3 Phi dp / (2 pi E) with Phi = 2.0 to 2.1 (Theret and others,
/// "The application of a homogeneous half-space model in the analysis of endothelial cell micropipette measurements",
/// J. Biomech. Eng. 110, 1988). The cell is 400 times the mouth, the lip nearly sharp, the contact closed over most of
/// the wall; a little above 2.1 remain of what is not infinite.
TEST(HeldCell, ASmallMouthOnALargeCellIsAHalfSpace) {
  Scene scene = heldScene();
  scene.cell.layers[0].outer_radius = 200e-6;
  scene.cell.material().model = "linear";
  scene.cell.material().poisson_ratio = 0.499;
  Scene::Mouth& mouth = *scene.holding_pipette.mouth;
  mouth.inner_radius = 0.5e-6;
  mouth.outer_radius = 1e-6;
  mouth.edge_radius = 0.01e-6;
  scene.holding_pipette.contact_radius = 0.51e-6;
  CellProblem<2> problem = problemOf(scene);
  double lengths[2];
  for (const int i : {0, 1}) {
    ASSERT_TRUE(problem.hold(-kModulus * 0.02 * (i + 1)).converged);
    lengths[i] = problem.held().tongue_length;
  }
  const double slope = (lengths[1] - lengths[0]) / mouth.inner_radius / 0.02;
  EXPECT_NEAR(slope * 2 * M_PI / 3, 2.05, 0.1);
}

/// Without suction the needle presses the cell against the lip, which then is all that holds it.
TEST(HeldCell, TheLipBearsTheNeedle) {
  Scene scene = heldScene();
  scene.holding_pipette.mouth->pressure = 0;
  CellProblem<2> problem = problemOf(scene);
  const IndentationSolution pressed = problem.solve({0, 0, -8e-6});
  ASSERT_TRUE(pressed.converged) << pressed.reason;
  EXPECT_NEAR(problem.held().clamping_force, pressed.force.z(), 1e-3 * pressed.force.z());
  EXPECT_EQ(pressed.tip_displacement, Eigen::Vector3d(0, 0, -8e-6));
}

/// What the needle feels on a held cell and on a glued one differs most where the holder gives way.
TEST(HeldCell, SuctionChangesTheNeedlesForceALittle) {
  Scene scene = heldScene(), glued = heldScene();
  glued.holding_pipette.mouth.reset();
  CellProblem<2> problem = problemOf(scene), reference = problemOf(glued);
  const IndentationSolution touch = problem.solve(Eigen::Vector3d::Zero());
  ASSERT_TRUE(touch.converged) << touch.reason;
  EXPECT_LT(touch.force.norm(), 1e-12);
  double before = 0;
  for (const double depth : {2e-6, 5e-6, 10e-6}) {
    const IndentationSolution held = problem.solve({0, 0, -depth}), fixed = reference.solve({0, 0, -depth});
    ASSERT_TRUE(held.converged && fixed.converged) << held.reason << fixed.reason;
    EXPECT_EQ(held.force.y(), 0);
    EXPECT_GT(held.force.z(), before);
    EXPECT_NEAR(held.force.z(), fixed.force.z(), 0.15 * fixed.force.z()) << depth;
    before = held.force.z();
  }
}

/// The needle's way to the cell takes no time: a relaxing cell has the same force with and without a stop at the touch.
TEST(HeldCell, TimeBeginsAtTheTouch) {
  Scene scene = heldScene();
  scene.cell.material().viscoelasticity.prony = {{2, 0.5}};
  CellProblem<2> at_once = problemOf(scene), with_a_stop = problemOf(scene);
  ASSERT_TRUE(with_a_stop.solve(Eigen::Vector3d::Zero()).converged);
  const IndentationSolution one = at_once.solve({0, 0, -2e-6}, 1), other = with_a_stop.solve({0, 0, -2e-6}, 1);
  ASSERT_TRUE(one.converged && other.converged) << one.reason << other.reason;
  EXPECT_NEAR(one.force.z(), other.force.z(), 0.01 * other.force.z());
}

/// Half a cell in space, with the needle in the plane y = 0: on the axis as its section, and pushed aside it pushes
/// back.
TEST(HeldCell, InAPlaneOfSymmetryItIsThatOfItsSection) {
  Scene scene = heldScene();
  Scene::Mouth& mouth = *scene.holding_pipette.mouth;
  mouth.inner_radius = 14e-6;
  mouth.outer_radius = 40e-6;
  mouth.edge_radius = 8e-6;
  mouth.pressure = -100;
  mouth.contact.mode = "sticking";
  scene.holding_pipette.contact_radius = 22e-6;
  scene.validate();
  CellProblem<3> space(scene, makeHalfSceneMesh(scene, -1), ElementKind::kP2P0, Symmetry::kMirror);
  CellProblem<2> section = problemOf(scene, -1);
  const IndentationSolution in_space = space.solve({0, 0, -3e-6}), in_section = section.solve({0, 0, -3e-6});
  ASSERT_TRUE(in_space.converged && in_section.converged) << in_space.reason << in_section.reason;
  EXPECT_NEAR(in_space.force.z(), in_section.force.z(), 0.03 * in_section.force.z());
  const HeldCell held = space.held(), flat = section.held();
  EXPECT_NEAR(held.tongue_length, flat.tongue_length, 0.03 * flat.tongue_length);
  EXPECT_NEAR(held.tongue_volume, flat.tongue_volume, 0.05 * flat.tongue_volume);
  EXPECT_NEAR(held.clamping_force, flat.clamping_force, 0.03 * flat.clamping_force);
  const IndentationSolution aside = space.solve({2e-6, 0, -3e-6});
  ASSERT_TRUE(aside.converged) << aside.reason;
  EXPECT_LT(aside.force.x(), -0.05 * aside.force.z());
  EXPECT_EQ(aside.force.y(), 0);
}

TEST(HeldCell, WithoutSymmetryInSpaceItIsRefused) {
  const Scene scene = heldScene();
  EXPECT_THROW(CellProblem<3>(scene, makeSceneMesh<3>(scene, -1), ElementKind::kP2P0), ConfigError);
}

}  // namespace
}  // namespace microinjection
