#include "cell/model/live_fem_cell.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "cell/model/cell_problem.h"
#include "cell/model/contact_frame.h"
#include "cell/model/converged_force.h"
#include "cell/model/live_cell_model.h"
#include "cell/model/lock_step.h"
#include "cell/model/scene_mesh.h"
#include "cell/model/test_scenes.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

/// Takes the tip along straight lines in virtual time.
class TipDriver {
 public:
  explicit TipDriver(const Scene& scene, const Eigen::Vector2d& line = Eigen::Vector2d::Zero())
      : cell(std::make_shared<const LiveFemCell>(scene)), tracker(cell, config()) {
    tip << line, 32e-6;
    force = tracker.step(tip, kUp, 0);
  }

  static LiveCellModelConfig config() {
    LiveCellModelConfig config;
    config.fixed_period = true;
    return config;
  }

  TipForce moveTo(const Eigen::Vector3d& goal, double speed) {
    const int steps = std::max(1, static_cast<int>(std::ceil((goal - tip).norm() / (speed * kStep))));
    const Eigen::Vector3d start = tip;
    for (int i = 1; i <= steps; ++i) rest(1, start + (goal - start) * i / steps);
    return force;
  }
  TipForce rest(int steps) { return rest(steps, tip); }

  std::shared_ptr<const LiveFemCell> cell;
  LiveCellModel tracker;
  Eigen::Vector3d tip;
  TipForce force;
  Eigen::Vector3d leap = Eigen::Vector3d::Zero();  ///< N, largest change of the force in a step
  double smallest_push = 0;                        ///< N
  bool always_trusted = true;

 private:
  TipForce rest(int steps, const Eigen::Vector3d& at) {
    tip = at;
    for (int i = 0; i < steps; ++i) {
      time_ += kStep;
      const TipForce now = tracker.step(tip, kUp, time_);
      if ((now.force - force.force).norm() > leap.norm()) leap = now.force - force.force;
      force = now;
      smallest_push = std::min(smallest_push, force.force.dot(kUp));
      always_trusted = always_trusted && force.valid;
    }
    return force;
  }
  double time_ = 0;
};

/// Straight down, in steps of the length that the tracker's have at 15 um/s: what sticks depends on them a little.
IndentationSolution direct(const Scene& scene, const Eigen::Vector2d& line, double depth) {
  constexpr double kSteps = 0.45e-6;  // m
  Scene there = scene;
  there.needle.offset = line;
  CellProblem<3> problem(there, makeSceneMesh<3>(there, LiveFemCell::kLevel), ElementKind::kP2P0);
  for (double way = 0.3e-6; way < depth; way += kSteps) problem.solve(-way * kUp);
  return problem.solve(-depth * kUp);
}

TEST(LiveFemCell, ServesTheForceOfTheFullSolution) {
  const Scene scene = pipetteScene();
  for (const Eigen::Vector2d& line : {Eigen::Vector2d(0, 0), Eigen::Vector2d(-9e-6, 9e-6)}) {
    TipDriver drive(scene, line);
    const Eigen::Vector3d touch = ContactFrame::at(scene, line)->origin;
    drive.moveTo(touch - 4e-6 * kUp, 15e-6);
    const TipForce force = drive.rest(70);
    ASSERT_TRUE(drive.always_trusted) << drive.tracker.invalidReason();
    ASSERT_TRUE(drive.tracker.contact());
    EXPECT_NEAR(drive.tracker.contact()->indentation, 4e-6, 1e-9);
    const IndentationSolution solution = direct(scene, line, 4e-6);
    ASSERT_TRUE(solution.converged) << solution.reason;
    EXPECT_LT((force.force - solution.force).norm(), 0.01 * solution.force.norm());
    EXPECT_GE(drive.smallest_push, 0);
    EXPECT_LT(drive.leap.norm(), 0.2 * force.force.norm());
  }
}

/// Nearer to the truth than anything that locks.
TEST(LiveFemCell, IsWithinItsErrorOfTheConvergedForce) {
  const Scene scene = pipetteScene();
  const IndentationSolution solution = direct(scene, {0, 0}, 5e-6);
  const std::vector<ForcePoint> truth = ConvergedForce(scene, {{5e-6}}, {}).solve();
  ASSERT_TRUE(truth[0].converged);
  EXPECT_NEAR(solution.force.z() / truth[0].force.z(), 1, 0.05);
}

TEST(LiveFemCell, FeelsTheTouchAtOnce) {
  TipDriver drive(pipetteScene());
  drive.moveTo({0, 0, 28e-6}, 20e-6);
  drive.rest(100);
  drive.moveTo({0, 0, 27.5e-6}, 1);  // one step: no solution of this contact yet
  EXPECT_TRUE(drive.force.valid) << drive.tracker.invalidReason();
  EXPECT_GT(drive.force.force.z(), 0.008e-6);
  EXPECT_LT(drive.force.force.z(), 0.024e-6);  // 0.016 uN
}

TEST(LiveFemCell, ATipThatLeapsIsNotTrustedUntilTheSolverHasFollowed) {
  TipDriver drive(pipetteScene());
  drive.moveTo({0, 0, 27e-6}, 15e-6);
  drive.rest(100);
  ASSERT_TRUE(drive.always_trusted) << drive.tracker.invalidReason();
  const TipForce lost = drive.moveTo({0, 0, 22e-6}, 1);
  EXPECT_FALSE(lost.valid);
  EXPECT_TRUE(lost.force.isZero(0));
  EXPECT_NE(drive.tracker.invalidReason().find("ahead of the last solution"), std::string::npos);
  EXPECT_FALSE(drive.rest(75).valid) << "a solution goes a quarter of the tip's radius at the most";
  EXPECT_TRUE(drive.rest(300).valid) << drive.tracker.invalidReason();
}

TEST(LiveFemCell, ReleasesAndTouchesAgainElsewhere) {
  const Scene scene = pipetteScene();
  TipDriver drive(scene);
  drive.moveTo({0, 0, 26e-6}, 15e-6);
  EXPECT_GT(drive.rest(100).force.z(), 0.05e-6);
  drive.moveTo({1e-6, 0, 29e-6}, 15e-6);
  EXPECT_FALSE(drive.tracker.contact());
  EXPECT_TRUE(drive.force.force.isZero(0));
  EXPECT_GE(drive.smallest_push, 0);
  const Eigen::Vector2d line(0, 10e-6);
  drive.moveTo({line.x(), line.y(), 32e-6}, 50e-6);
  const Eigen::Vector3d touch = ContactFrame::at(scene, line)->origin;
  drive.moveTo(touch - 2e-6 * kUp, 15e-6);
  drive.rest(70);
  EXPECT_TRUE(drive.always_trusted) << drive.tracker.invalidReason();
  const IndentationSolution solution = direct(scene, line, 2e-6);
  EXPECT_LT((drive.force.force - solution.force).norm(), 0.01 * solution.force.norm());
  EXPECT_GT(drive.force.force.y(), 0) << "the cell pushes it off";
}

/// Moved off the cell sideways, below the height where it touched, it is free.
TEST(LiveFemCell, ATipThatLeavesSidewaysIsReleased) {
  TipDriver drive(pipetteScene());
  drive.moveTo({0, 0, 27.7e-6}, 15e-6);
  drive.moveTo({9e-6, 0, 27.7e-6}, 15e-6);
  drive.rest(300);
  EXPECT_FALSE(drive.tracker.contact());
  EXPECT_TRUE(drive.force.valid);
}

/// A disc is off where it is above the cell, beside it, or above where it touched; not where it only went sideways.
TEST(LiveFemCell, ADiscIsOffWhereTheCellIsNot) {
  Scene scene = pipetteScene();
  scene.needle.tip.shape = "disc";
  const LiveFemCell cell(scene);
  const Eigen::Vector3d pole(0, 0, 28e-6);
  EXPECT_TRUE(cell.isClear({40e-6, 0, 20e-6}, kUp, pole)) << "passes by";
  EXPECT_TRUE(cell.isClear({10e-6, 0, 26.3e-6}, kUp, pole)) << "the surface is at 26.15 um";
  EXPECT_TRUE(cell.isClear({0, 0, 28.1e-6}, kUp, pole));
  EXPECT_FALSE(cell.isClear({10e-6, 0, 26e-6}, kUp, pole));
  EXPECT_FALSE(cell.isClear({0, 0, 27e-6}, kUp, pole));
}

TEST(LiveFemCell, SamePathSameBits) {
  const Scene scene = pipetteScene();
  TipDriver a(scene), b(scene);
  for (const Eigen::Vector3d& goal : {Eigen::Vector3d(0, 0, 26e-6), Eigen::Vector3d(1e-6, 0, 26e-6)}) {
    EXPECT_EQ(a.moveTo(goal, 20e-6).force, b.moveTo(goal, 20e-6).force);
  }
  EXPECT_GT(a.force.force.norm(), 0);
}

TEST(LiveFemCell, ATiltedNeedleIsNotTrusted) {
  TipDriver drive(pipetteScene());
  const Eigen::Vector3d tilted = Eigen::Vector3d(0.2, 0, 1).normalized();
  EXPECT_FALSE(drive.tracker.step({0, 0, 26e-6}, tilted, 1).valid);
  EXPECT_NE(drive.tracker.invalidReason().find("upright"), std::string::npos);
}

/// Upside down it is refused where it is in the cell, and where it is not, it is no contact in any step.
TEST(LiveFemCell, ANeedleFromBelowIsNotTrustedInTheCellAndFreeAboveIt) {
  TipDriver drive(pipetteScene());
  EXPECT_FALSE(drive.tracker.step({0, 0, -20e-6}, -kUp, 1).valid);
  EXPECT_NE(drive.tracker.invalidReason().find("upright"), std::string::npos);
  TipDriver above(pipetteScene());
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(above.tracker.step({0, 0, 40e-6}, -kUp, 1 + i * kStep).valid);
    EXPECT_EQ(above.tracker.invalidReason(), "") << "touched what it is not near";
  }
}

/// A Prony cell pushed fast resists more, and relaxes to the elastic force.
TEST(LiveFemCell, AViscoelasticCellRelaxes) {
  Scene scene = pipetteScene();
  scene.cell.material().viscoelasticity.prony = {{1, 0.05}};
  TipDriver drive(scene);
  const double fast = drive.moveTo({0, 0, 26e-6}, 15e-6).force.z();
  const double relaxed = drive.rest(400).force.z();
  const IndentationSolution elastic = direct(pipetteScene(), {0, 0}, 2e-6);
  EXPECT_GT(fast, 1.2 * elastic.force.z());
  EXPECT_LT(fast, 2 * elastic.force.z());
  EXPECT_NEAR(relaxed, elastic.force.z(), 0.03 * elastic.force.z());
}

/// What stuck and what relaxed in the last contact is forgotten.
TEST(LiveFemCell, ANewContactStartsFromTheUndeformedCell) {
  Scene scene = pipetteScene();
  scene.cell.material().viscoelasticity.prony = {{1, 0.05}};
  const LiveFemCell cell(scene);
  const ContactPoint place = cell.contactAt(28e-6 * kUp, kUp);
  const auto used = cell.path(place), fresh = cell.path(place);
  ASSERT_TRUE(used->follow({{0.2e-6, 0, -0.7e-6}, 0, 0.0, 0.02}).converged);
  const TipMotion again = {-0.5e-6 * kUp, 1, 1.0, 1.02};
  const IndentationSolution second = used->follow(again), first = fresh->follow(again);
  ASSERT_TRUE(first.converged) << first.reason;
  EXPECT_GT(first.force.z(), 0);
  EXPECT_EQ(second.force, first.force);
}

TEST(LiveFemCell, ShowsTheSurfaceAsSolved) {
  TipDriver drive(pipetteScene(), {8e-6, 0});
  const auto triangles = drive.tracker.triangles();
  const CellModel::DeformedSurface free = drive.tracker.deformedSurface();
  EXPECT_FALSE(drive.tracker.held().empty());
  for (const auto& t : triangles) {  // seen from outside
    const Eigen::Vector3d &a = free.vertices[t[0]], &b = free.vertices[t[1]], &c = free.vertices[t[2]];
    ASSERT_GT((b - a).cross(c - a).dot(a + b + c), 0);
  }
  const Eigen::Vector3d touch = ContactFrame::at(pipetteScene(), {8e-6, 0})->origin;
  drive.moveTo(touch - 4e-6 * kUp, 15e-6);
  drive.rest(70);
  const CellModel::DeformedSurface pressed = drive.tracker.deformedSurface();
  ASSERT_EQ(pressed.vertices.size(), free.vertices.size());
  for (std::size_t i = 0; i < pressed.vertices.size(); ++i) {
    ASSERT_NEAR((pressed.vertices[i] - pressed.at_rest[i]).norm(), pressed.displacement[i], 1e-12);
    ASSERT_NEAR(pressed.at_rest[i].norm(), pipetteScene().radius(), 1e-9) << "at rest it is a ball";
  }
  const auto deepest = std::max_element(pressed.displacement.begin(), pressed.displacement.end());
  const Eigen::Vector3d there = pressed.vertices[deepest - pressed.displacement.begin()];
  EXPECT_GT(*deepest, 3e-6);
  EXPECT_LT(*deepest, 4.3e-6);
  EXPECT_LT((there - (drive.tip + Eigen::Vector3d(0, 0, 1e-6))).norm(), 3e-6) << "it is under the tip";
}

TEST(LiveFemCell, ShowsTheBordersBetweenItsLayers) {
  Scene scene = pipetteScene();
  scene.cell.layers.push_back(scene.cell.layers.front());
  scene.cell.layers[1].name = "cytoplasm";
  scene.cell.layers[1].outer_radius = 22e-6;
  scene.cell.layers[1].material.young_modulus = 2e3;
  TipDriver drive(scene);
  const auto borders = drive.tracker.borders();
  ASSERT_FALSE(borders.empty());
  const std::vector<Eigen::Vector3d> free = drive.tracker.deformedSurface().border_vertices;
  for (const auto& border : borders) {  // seen from outside
    ASSERT_EQ(border.layer, 1);
    const auto& [a, b, c] = border.vertices;
    ASSERT_GT((free[b] - free[a]).cross(free[c] - free[a]).dot(free[a] + free[b] + free[c]), 0);
  }
  for (const Eigen::Vector3d& vertex : free) ASSERT_NEAR(vertex.norm(), 22e-6, 1e-9);
  drive.moveTo(Eigen::Vector3d(0, 0, 24e-6), 15e-6);
  drive.rest(70);
  const auto pressed = drive.tracker.deformedSurface().border_vertices;
  ASSERT_EQ(pressed.size(), free.size());
  const auto top =
      std::max_element(free.begin(), free.end(), [](const auto& a, const auto& b) { return a.z() < b.z(); });
  const double sunk = top->z() - pressed[top - free.begin()].z();
  EXPECT_GT(sunk, 1e-6) << "less than the tip, which is 4 um deep";
  EXPECT_LT(sunk, 4e-6);
}

}  // namespace
}  // namespace microinjection
