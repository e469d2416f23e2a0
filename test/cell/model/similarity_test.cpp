#include "cell/model/similarity.h"

#include <gtest/gtest.h>

#include "cell/model/cell_problem.h"
#include "cell/model/scene_description.h"
#include "cell/model/scene_mesh.h"

namespace microinjection {
namespace {

/// A zona with tension around a soft cytoplasm, under a round pipette.
Scene layeredCell() {
  Scene scene;
  Scene::Layer cytoplasm;
  cytoplasm.name = "cytoplasm";
  cytoplasm.outer_radius = 22e-6;
  cytoplasm.material.young_modulus = 1.1e3;
  scene.cell.layers.front().surface_tension = 2e-3;
  scene.cell.layers.push_back(cytoplasm);
  scene.needle.tip.shape = "hemisphere";
  return scene;
}

/// The same cell, larger by `length` and stiffer by `modulus`.
Scene similar(Scene scene, double length, double modulus) {
  for (Scene::Layer& layer : scene.cell.layers) {
    layer.outer_radius *= length;
    layer.material.young_modulus *= modulus;
    layer.surface_tension *= modulus * length;
  }
  scene.holding_pipette.contact_radius *= length;
  scene.needle.tip.radius *= length;
  scene.needle.tip.edge_radius *= length;
  scene.needle.contact.adhesion_energy *= modulus * length;
  scene.needle.contact.adhesion_range *= length;
  scene.needle.offset *= length;
  if (scene.mesh.size) *scene.mesh.size *= length;
  return scene;
}

/// Force over E R^2 of the section at a depth of 0.1 R.
double dimensionlessForce(const Scene& scene) {
  const Similarity units = Similarity::of(scene);
  CellProblem<2> problem(scene, makeSceneMesh<2>(scene, -1), ElementKind::kP2P0);
  const IndentationSolution solution = problem.solve({0, 0, -0.1 * units.length});
  EXPECT_TRUE(solution.converged) << solution.reason;
  return solution.force.z() / units.force();
}

TEST(Similarity, ScaledAndStiffenedCellsAreTheSameWithoutDimension) {
  Scene scene = layeredCell();
  scene.needle.tip.shape = "rounded_flat";
  scene.needle.tip.edge_radius = 1e-6;
  scene.needle.contact.adhesion_energy = 1e-4;
  scene.needle.contact.adhesion_range = 0.1e-6;
  scene.needle.offset = {3e-6, 1e-6};
  scene.mesh.size = 5e-6;
  const Scene units = withoutDimension(scene);
  EXPECT_EQ(units.radius(), 1);
  EXPECT_EQ(units.cell.material().young_modulus, 1);
  EXPECT_NEAR(units.cell.layers[1].outer_radius, 22.0 / 28, 1e-12);
  EXPECT_NEAR(units.needle.tip.edge_radius, 1.0 / 28, 1e-12);
  EXPECT_NEAR(units.cell.layers[0].surface_tension, 2e-3 / (17.9e3 * 28e-6), 1e-12);
  for (const double length : {1.0, 3.7, 1 / 28e-6}) {
    for (const double modulus : {1.0, 0.31, 1 / 17.9e3}) {
      const Scene other = withoutDimension(similar(scene, length, modulus));
      EXPECT_EQ(describeCellAndTip(other), describeCellAndTip(units));
      EXPECT_EQ(other.needle.offset, units.needle.offset);
      EXPECT_EQ(other.needle.contact.adhesion_energy, units.needle.contact.adhesion_energy);
      EXPECT_EQ(other.needle.contact.adhesion_range, units.needle.contact.adhesion_range);
      EXPECT_EQ(other.mesh.size, units.mesh.size);
    }
  }
  EXPECT_EQ(describeCellAndTip(withoutDimension(units)), describeCellAndTip(units));
}

TEST(Similarity, ForcesOfSimilarCellsAgreeToTheSolversTolerance) {
  const Scene scene = layeredCell();
  const double expected = dimensionlessForce(scene);
  EXPECT_GT(expected, 1e-3);
  EXPECT_NEAR(dimensionlessForce(withoutDimension(scene)), expected, 1e-6 * expected);
  EXPECT_NEAR(dimensionlessForce(similar(scene, 12.5, 0.06)), expected, 1e-6 * expected);
  Scene stiffer = scene;
  stiffer.cell.layers[1].material.young_modulus *= 2;  // another ratio
  EXPECT_GT(dimensionlessForce(stiffer), 1.05 * expected);
}

}  // namespace
}  // namespace microinjection
