#include "cell/model/live_cell_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "cell/model/indentation.h"
#include "cell/model/lock_step.h"
#include "cell/model/scene.h"
#include "cell/model/test_scenes.h"

namespace microinjection {
namespace {

/// Takes the tip along a straight line in virtual time.
class ModelDriver {
 public:
  explicit ModelDriver(const Scene& scene) : cell(std::make_shared<const P1Cell>(scene)), tracker(cell, config()) {}

  static LiveCellModelConfig config() {
    LiveCellModelConfig config;
    config.fixed_period = true;
    return config;
  }

  TipForce moveTo(const Eigen::Vector3d& goal, double speed) {
    const int steps = std::max(1, static_cast<int>(std::ceil((goal - tip).norm() / (speed * kStep))));
    const Eigen::Vector3d start = tip;
    for (int i = 1; i <= steps; ++i) force = rest(1, start + (goal - start) * i / steps);
    return force;
  }
  TipForce rest(int steps) { return rest(steps, tip); }

  std::shared_ptr<const P1Cell> cell;
  LiveCellModel tracker;
  Eigen::Vector3d tip{0, 0, 40e-6};
  TipForce force;
  double smallest_push = 0;  ///< N along the axis, over the whole way
  bool always_trusted = true;

 private:
  TipForce rest(int steps, const Eigen::Vector3d& at) {
    tip = at;
    for (int i = 0; i < steps; ++i) {
      time_ += kStep;
      force = tracker.step(tip, kAxis, time_);
      smallest_push = std::min(smallest_push, force.force.dot(kAxis));
      always_trusted = always_trusted && force.valid;
    }
    return force;
  }
  double time_ = 0;
};

TEST(LiveCellModel, FreeNeedleFeelsNothing) {
  ModelDriver drive(coarseScene("neo_hookean"));
  const TipForce force = drive.moveTo({0, 0, 28.1e-6}, 100e-6);
  EXPECT_TRUE(force.valid);
  EXPECT_EQ(force.force, Eigen::Vector3d::Zero().eval());
  EXPECT_FALSE(drive.tracker.contact());
}

TEST(LiveCellModel, ForceAgreesWithTheSolutionOnceItHasCaughtUp) {
  ModelDriver drive(coarseScene("neo_hookean"));
  drive.moveTo({0, 0, 24e-6}, 50e-6);
  const TipForce force = drive.rest(100);
  ASSERT_TRUE(drive.always_trusted) << drive.tracker.invalidReason();
  ASSERT_TRUE(drive.tracker.contact());
  EXPECT_NEAR(drive.tracker.contact()->indentation, 4e-6, 1e-7);  // faceting of the pole

  Indentation alone(drive.cell, drive.tracker.patch());
  const IndentationSolution solution = alone.solve(drive.tracker.contact()->displacement);
  ASSERT_TRUE(solution.converged) << solution.reason;
  EXPECT_LT((force.force - solution.force).norm(), 1e-5 * solution.force.norm());
  EXPECT_GT(force.force.z(), 0.2e-6);
}

TEST(LiveCellModel, ExtrapolatesBetweenSolutions) {
  ModelDriver drive(coarseScene("neo_hookean"));
  drive.moveTo({0, 0, 26e-6}, 50e-6);
  drive.rest(100);
  const double before = drive.force.force.z();
  const double stiffness = drive.tracker.solution(0)->stiffness(2, 2);
  drive.moveTo({0, 0, 25.9e-6}, 1);  // one step, long before the next solution
  EXPECT_NEAR(drive.force.force.z() - before, stiffness * 0.1e-6, 1e-6 * stiffness * 0.1e-6);
  EXPECT_GT(stiffness, 0.1);
}

TEST(LiveCellModel, RetractionReturnsTheForceToZeroAndNeverPulls) {
  ModelDriver drive(coarseScene("neo_hookean"));
  drive.moveTo({0, 0, 25e-6}, 50e-6);
  drive.rest(50);
  drive.moveTo({0, 0, 35e-6}, 50e-6);
  EXPECT_TRUE(drive.always_trusted);
  EXPECT_EQ(drive.force.force, Eigen::Vector3d::Zero().eval());
  EXPECT_FALSE(drive.tracker.contact());
  EXPECT_GE(drive.smallest_push, 0);
  drive.moveTo({0, 0, 26e-6}, 50e-6);
  EXPECT_GT(drive.rest(100).force.z(), 0.1e-6) << "the cell must be there the second time";
}

TEST(LiveCellModel, SamePathSameBits) {
  ModelDriver a(coarseScene("neo_hookean")), b(coarseScene("neo_hookean"));
  for (const Eigen::Vector3d& goal : {Eigen::Vector3d(0, 0, 24e-6), Eigen::Vector3d(1e-6, 0, 24e-6)}) {
    EXPECT_EQ(a.moveTo(goal, 80e-6).force, b.moveTo(goal, 80e-6).force);
  }
  EXPECT_GT(a.force.force.norm(), 0);
  EXPECT_LT(a.force.force.x(), 0) << "a tip dragged along x is pulled back";
}

TEST(LiveCellModel, APoseThatIsNoNumberIsNotTrustedAndForgotten) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ModelDriver drive(coarseScene("linear"));
  drive.moveTo({0, 0, 27e-6}, 50e-6);
  const TipForce before = drive.rest(100);
  ASSERT_TRUE(before.valid && before.force.z() > 0);
  for (const TipForce& force :
       {drive.tracker.step({kNan, 0, 27e-6}, kAxis, 1), drive.tracker.step(drive.tip, {0, 0, kNan}, 1),
        drive.tracker.step(drive.tip, kAxis, kNan)}) {
    EXPECT_FALSE(force.valid);
    EXPECT_TRUE(force.force.isZero(0));
    EXPECT_NE(drive.tracker.invalidReason(), "");
  }
  EXPECT_EQ(drive.rest(1).force, before.force);
  EXPECT_TRUE(drive.force.valid);
  LiveCellModel away(drive.cell, ModelDriver::config());
  EXPECT_FALSE(away.step({0, 0, kNan}, kAxis, 0).valid);
}

TEST(LiveCellModel, SaysSoWhereTheModelHasNoSolutionAndRecovers) {
  ModelDriver drive(coarseScene("st_venant_kirchhoff"));
  drive.moveTo({0, 0, 27.5e-6}, 20e-6);
  ASSERT_TRUE(drive.always_trusted) << drive.tracker.invalidReason();
  drive.moveTo({0, 0, 8e-6}, 100e-6);
  const TipForce lost = drive.rest(200);
  EXPECT_FALSE(lost.valid);
  EXPECT_EQ(lost.force, Eigen::Vector3d::Zero().eval());
  EXPECT_FALSE(drive.tracker.invalidReason().empty());
  drive.moveTo({0, 0, 27.5e-6}, 100e-6);
  EXPECT_TRUE(drive.rest(100).valid) << drive.tracker.invalidReason();
  EXPECT_GT(drive.force.force.z(), 0);
}

TEST(LiveCellModel, ATipThatLeapsIsNotTrustedUntilTheSolverHasFollowed) {
  ModelDriver drive(coarseScene("neo_hookean"));
  drive.moveTo({0, 0, 27e-6}, 50e-6);
  drive.rest(100);
  EXPECT_FALSE(drive.moveTo({0, 0, 23e-6}, 1).valid);
  EXPECT_NE(drive.tracker.invalidReason().find("ahead of the last solution"), std::string::npos);
  EXPECT_TRUE(drive.rest(100).valid);
}

TEST(LiveCellModel, ATremblingHandMakesNoOtherContact) {
  ModelDriver still(coarseScene("neo_hookean")), trembling(coarseScene("neo_hookean"));
  still.moveTo({0, 0, 29e-6}, 50e-6);
  for (int i = 0; i < 200; ++i) trembling.moveTo({(i % 7 - 3) * 0.05e-6, (i % 5 - 2) * 0.05e-6, 29e-6}, 1);
  still.moveTo({0, 0, 26e-6}, 50e-6);
  trembling.moveTo({0.1e-6, -0.1e-6, 26e-6}, 50e-6);
  EXPECT_EQ(trembling.tracker.patch().vertices, still.tracker.patch().vertices);
  EXPECT_TRUE(trembling.always_trusted) << trembling.tracker.invalidReason();
  EXPECT_NEAR(trembling.rest(100).force.z(), still.rest(100).force.z(), 0.02 * still.force.force.z());
}

TEST(LiveCellModel, AContactThatTheSolverRefusesIsNotTrusted) {
  ModelDriver drive(coarseScene("neo_hookean"));
  TipForce force;
  for (int i = 0; i < 200; ++i) {
    force = drive.tracker.step({0, 0, -27e-6}, -kAxis, i * kStep);  // from below, onto the held vertices
  }
  EXPECT_FALSE(force.valid);
  EXPECT_NE(drive.tracker.invalidReason().find("held"), std::string::npos) << drive.tracker.invalidReason();
}

/// Beside the cell, below the height where it touched, there is nothing to be in contact with.
TEST(LiveCellModel, ATipThatLeapsAsideIsReleased) {
  ModelDriver drive(coarseScene("neo_hookean"));
  drive.moveTo({0, 0, 27e-6}, 50e-6);
  drive.rest(50);
  ASSERT_TRUE(drive.tracker.contact());
  for (const Eigen::Vector3d& aside : {Eigen::Vector3d(40e-6, 0, 20e-6), Eigen::Vector3d(0, 25e-6, 20e-6)}) {
    drive.moveTo(aside, 1);
    const TipForce force = drive.rest(50);
    EXPECT_FALSE(drive.tracker.contact());
    EXPECT_TRUE(force.valid) << drive.tracker.invalidReason();
    EXPECT_TRUE(force.force.isZero(0));
    drive.moveTo({0, 0, 29e-6}, 1);
    drive.rest(50);
    drive.moveTo({0, 0, 27e-6}, 50e-6);
    EXPECT_GT(drive.rest(50).force.z(), 0.05e-6) << "the cell must be there the next time";
  }
}

TEST(LiveCellModel, TouchesWhereTheNeedlesLineMeetsTheCell) {
  ModelDriver drive(coarseScene("neo_hookean"));
  drive.tip = {8e-6, 0, 40e-6};
  drive.moveTo({8e-6, 0, 25e-6}, 50e-6);
  drive.rest(100);
  ASSERT_TRUE(drive.tracker.contact());
  const double surface = std::sqrt(28e-6 * 28e-6 - 8e-6 * 8e-6);
  EXPECT_NEAR(drive.tracker.contact()->contact_point.z(), surface, 0.5e-6);
  for (const int vertex : drive.tracker.patch().vertices) {
    EXPECT_LT((drive.cell->mesh().vertices[vertex].head<2>() - Eigen::Vector2d(8e-6, 0)).norm(), 6e-6);
  }
  EXPECT_GT(drive.force.force.z(), 0);
}

}  // namespace
}  // namespace microinjection
