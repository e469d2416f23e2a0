#include "cell/model/tensegrity_cell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/errors.h"
#include "cell/model/converged_force.h"
#include "cell/model/live_cell_model.h"
#include "cell/model/live_fem_cell.h"
#include "cell/model/p1_cell.h"
#include "cell/model/scene_texts.h"

namespace microinjection {
namespace {

constexpr char kTensegrityScene[] = R"(
cell:
  model: tensegrity
  diameter: 56e-6
  actin: {count: 10, prestrain: 0.05}
  intermediate_filaments: {count: 10, prestrain: 0.05}
  microtubules: {count: 4000}
  membrane: {divisions: 4}
needle: {tip: {shape: disc, radius: 3e-6}}
)";

Scene tensegrityScene() { return parseScene(YAML::Load(kTensegrityScene), "scene.yaml"); }

std::string errorsWith(const std::string& path, const std::string& key, const std::string& value) {
  YAML::Node node = YAML::Load(kTensegrityScene);
  YAML::Node at = path.empty() ? node : node["cell"];
  if (path != "cell" && !path.empty()) at.reset(node["cell"][path]);
  at[key] = YAML::Load(value);
  return errorsOf(node);
}

TEST(TensegrityScene, IsRead) {
  const Scene read = tensegrityScene();
  ASSERT_TRUE(read.cell.tensegrity);
  EXPECT_EQ(read.cell.tensegrity->actin.filaments.count, 10);
  EXPECT_EQ(read.cell.tensegrity->microtubules.filaments.young_modulus, 1.2e9);
  EXPECT_EQ(read.cell.tensegrity->membrane.divisions, 4);
  EXPECT_EQ(read.radius(), 28e-6);
  EXPECT_FALSE(parseScene(YAML::Load(kGood), "scene.yaml").cell.tensegrity);
  EXPECT_TRUE(loadScene(MICROINJECTION_SOURCE_DIR "/config/cells/mouse_oocyte_tensegrity.yaml").cell.tensegrity);
}

TEST(TensegrityScene, ErrorsNameKeyAndWhatIsAllowed) {
  expectIn(errorsWith("cell", "material", "{model: linear}"), {"cell/material", "unknown"});
  expectIn(errorsWith("cell", "orientation", "up"), {"cell/orientation", "face", "edge", "vertex"});
  expectIn(errorsWith("cell", "cut", "36"), {"cell/cut", "36"});
  expectIn(errorsWith("actin", "prestrain", "-0.1"), {"cell/actin/prestrain", "-0.1"});
  expectIn(errorsWith("actin", "stiffness", "1"), {"cell/actin/stiffness"});
  expectIn(errorsWith("microtubules", "slices", "7"), {"cell/microtubules/slices", "even"});
  expectIn(errorsWith("microtubules", "model", "neo_hookean"), {"cell/microtubules/model", "corotated"});
  expectIn(errorsWith("intermediate_filaments", "prestrain", "3"), {"cell/intermediate_filaments/prestrain", "actin"});
  expectIn(errorsWith("", "holding_pipette", "{contact_radius: 1e-5}"), {"holding_pipette", "left out"});
  expectIn(errorsWith("", "mesh", "{size: 1e-5}"), {"mesh", "left out"});
  expectIn(errorsWith("", "requirements", "{rate: 1000}"), {"requirements", "left out"});
  expectIn(errorsWith("cell", "biomembrane", "{thickness: 4e-6, dimple_radius: 1e-5}"),
           {"cell/biomembrane", "left out"});
  expectIn(errorsWith("", "needle", "{tip: {shape: hemisphere, radius: 3e-6}}"), {"needle/tip/shape", "disc"});
  YAML::Node missing = YAML::Load(kTensegrityScene);
  missing["cell"]["actin"].remove("count");
  missing["cell"].remove("microtubules");
  expectIn(errorsOf(missing), {"cell/actin/count", "cell/microtubules"});  // all at once
}

TEST(TensegrityScene, IsRefusedByModelsOfTheContinuum) {
  EXPECT_THROW(P1Cell cell(tensegrityScene()), ConfigError);
  EXPECT_THROW(LiveFemCell cell(tensegrityScene()), ConfigError);
  EXPECT_THROW(ConvergedForce(tensegrityScene(), {}, {}), ConfigError);
  EXPECT_THROW(TensegrityCell cell(parseScene(YAML::Load(kGood), "scene.yaml")), ConfigError);
}

/// On the surface of the cell, the strut ends are vertices of it, and three are held.
TEST(TensegrityCell, NeedleMeetsTheMembraneAnywhere) {
  const auto cell = std::make_shared<const TensegrityCell>(tensegrityScene());
  EXPECT_EQ(cell->heldVertices().size(), 3u);
  EXPECT_EQ(cell->surface().vertices.size(), 10u * 4 * 4 + 2);
  const TensegrityGeometry& geometry = cell->structure().geometry();
  const double up = 2 * 28e-6;
  for (const double x : {-20e-6, 0.0, 10e-6}) {
    const auto hit = cell->hit({x, 0, up}, -Eigen::Vector3d::UnitZ());
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->point.norm() / 28e-6, 1, 0.05);
  }
  // Exactly on a strut's end, and exactly between the three on top.
  const Eigen::Vector3d end = geometry.ends[3];
  ASSERT_GT(end.z(), 20e-6);
  const TipPatch on = cell->patchAt(end, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(std::count(on.vertices.begin(), on.vertices.end(), cell->structure().endNode(3)), 1);
  const auto on_end = cell->indentation(on);
  const auto between = cell->indentation(cell->patchAt({0, 0, 28e-6}, Eigen::Vector3d::UnitZ()));
  const IndentationSolution hard = on_end->solve({0, 0, -1e-6}), soft = between->solve({0, 0, -1e-6});
  ASSERT_TRUE(hard.converged && soft.converged);
  EXPECT_GT(hard.force.z(), 5 * soft.force.z());
  EXPECT_GT(soft.force.z(), 0);
  EXPECT_LT(soft.force.head<2>().norm(), 1e-3 * soft.force.z());  // three-fold symmetry
  EXPECT_THROW(cell->indentation(TipPatch{{cell->heldVertices()[0]}}), std::invalid_argument);
}

/// In virtual time: a needle on a strut's end, with the tracker that serves every live cell.
TEST(TensegrityCell, ServesAMovingNeedle) {
  const auto cell = std::dynamic_pointer_cast<const TensegrityCell>(makeLiveCell(tensegrityScene()));
  ASSERT_TRUE(cell);
  LiveCellModelConfig config;
  config.fixed_period = true;
  LiveCellModel tracker(cell, config);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), end = cell->structure().geometry().ends[3];
  double time = 0;
  const auto step = [&](double height) { return tracker.step({end.x(), end.y(), end.z() + height}, up, time += 1e-3); };
  EXPECT_EQ(tracker.deformedSurface().members.size(), cell->undeformedMembers().size());
  for (double height = 5e-6; height > -2e-6; height -= 2e-8) step(height);
  TipForce force;
  for (int i = 0; i < 100; ++i) force = step(-2e-6);
  ASSERT_TRUE(force.valid) << tracker.invalidReason();
  const auto alone = cell->indentation(tracker.patch());
  const IndentationSolution expected = alone->solve(tracker.contact()->displacement);
  ASSERT_TRUE(expected.converged);
  EXPECT_NEAR(force.force.z() / expected.force.z(), 1, 1e-3);
  double largest = 0;
  for (const auto& member : tracker.deformedSurface().members) largest = std::max(largest, member.force);
  EXPECT_GT(largest, 1.05 * cell->structure().form().prestress);
  for (const auto& member : cell->undeformedMembers()) {
    const bool strut = member.kind == CellModel::Member::Kind::kStrut;
    EXPECT_EQ(member.force < 0, strut);
  }
}

/// Kelvin-Voigt cables: 1 um in a tenth of their time meets more than 1 um in ever so long, and rests to the same.
TEST(TensegrityCell, ViscousCablesFeelTheTipsSpeed) {
  Scene viscous = tensegrityScene();
  viscous.cell.tensegrity->actin.retardation_time = viscous.cell.tensegrity->intermediate.retardation_time = 1;
  const TensegrityCell cell(viscous), elastic(tensegrityScene());
  const Eigen::Vector3d end = cell.structure().geometry().ends[3], way(0, 0, -1e-6), none = Eigen::Vector3d::Zero();
  const ContactPoint place = cell.contactAt(end, Eigen::Vector3d::UnitZ());
  const double rested = elastic.path(place)->follow({way, 0, 0.0, 1.0}).force.z();
  const auto path = cell.path(place);
  ASSERT_TRUE(path->follow({none, 0, std::nullopt, 6.0}).converged);
  const double quick = path->follow({way, 0, 7.0, 7.1}).force.z();
  EXPECT_GT(quick, 3 * rested);
  EXPECT_NEAR(path->follow({way, 0, 7.0, 1e4}).force.z() / rested, 1, 1e-3);
  // A new contact has no memory of it, however it is asked; a slow tip feels nothing viscous.
  EXPECT_NEAR(path->follow({way, 1, 2e4, 2e4 + 0.1}).force.z() / quick, 1, 1e-6);
  EXPECT_NEAR(path->follow({way, 2, 3e4, 4e4}).force.z() / rested, 1, 1e-3);
}

/// A tangent of a way that took one period counts the viscous part of the force in again over each period, and a
/// solution serves until two periods after it was asked for: what a needle at constant speed feels is off by twice that
/// part. With the tangent of the first way after the touch, which took next to no time, it would be off by ten times
/// the force.
TEST(TensegrityCell, ViscousCablesAreNotStifferBetweenSolutions) {
  constexpr double kSpeed = 10e-6, kDeepest = 2e-6;  // m/s, m
  Scene viscous = tensegrityScene();
  viscous.cell.tensegrity->actin.retardation_time = viscous.cell.tensegrity->intermediate.retardation_time = 0.05;
  const auto cell = std::make_shared<const TensegrityCell>(viscous);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), end = cell->structure().geometry().ends[3];
  const auto path = cell->indentation(cell->patchAt(end, up));
  double solved = 0;
  for (int i = 1; i <= 20; ++i) solved = path->solve({0, 0, -kDeepest * i / 20}, kDeepest / kSpeed / 20).force.z();
  LiveCellModelConfig config;
  config.fixed_period = true;
  LiveCellModel tracker(cell, config);
  double largest = 0, last = 0;
  for (int i = 0; 1e-3 * i * kSpeed < 5e-6 + kDeepest; ++i) {
    const TipForce force = tracker.step(end + (5e-6 - 1e-3 * i * kSpeed) * up, up, 1e-3 * i);
    EXPECT_TRUE(force.valid) << tracker.invalidReason();
    last = force.force.z();
    largest = std::max(largest, last);
  }
  const double elastic = cell->indentation(cell->patchAt(end, up))->solve({0, 0, -kDeepest}).force.z();
  ASSERT_GT(solved, 1.1 * elastic);
  EXPECT_GT(last, elastic);
  EXPECT_LT(largest, solved + 2.5 * (solved - elastic));
}

/// The picture is the membrane's: the patch has moved with the tip, what is held has not.
TEST(TensegrityCell, PictureMovesWithTheTip) {
  const TensegrityCell cell(tensegrityScene());
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), way(0, 0, -2e-6);
  const ContactPoint place = cell.contactAt({0, 0, 28e-6}, up);
  const auto path = cell.path(place);
  ASSERT_TRUE(path->follow({way, 0, 0.0, 1.0}).converged);
  const LiveCell::Surface rest = cell.undeformedSurface();
  const Eigen::VectorXd moved = path->surfaceDisplacement();
  ASSERT_EQ(moved.size(), 3 * static_cast<Eigen::Index>(rest.vertices.size()));
  EXPECT_EQ(cell.onSurface(place.patch).size(), place.patch.vertices.size());
  for (const auto i : cell.onSurface(place.patch)) EXPECT_LT((moved.segment<3>(3 * i) - way).norm(), 1e-15);
  EXPECT_EQ(rest.held.size(), 3u);
  for (const auto i : rest.held) EXPECT_EQ(moved.segment<3>(3 * i).norm(), 0);
  EXPECT_EQ(path->members().size(), cell.undeformedMembers().size());
}

}  // namespace
}  // namespace microinjection
