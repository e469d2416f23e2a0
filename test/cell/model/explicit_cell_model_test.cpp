#include "cell/model/explicit_cell_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "base/errors.h"
#include "cell/model/lock_step.h"
#include "cell/model/test_scenes.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

constexpr double kTouch = 28e-6;              // m, z of the pole
const ExplicitCellModelConfig kConfig{1e-4};  // settles in a tenth of a second

class ExplicitCellModelTest : public testing::Test {
 protected:
  TipForce moveTo(double depth, double duration) {
    const int steps = std::max(1, static_cast<int>(std::lround(duration / kStep)));
    const double start = depth_;
    for (int i = 1; i <= steps; ++i) step(start + (depth - start) * i / steps);
    return force_;
  }
  double settledAt3um() {
    moveTo(3e-6, 0.3);
    return rest(1.5).force.z();
  }
  TipForce rest(double duration) { return moveTo(depth_, duration); }

  void step(double depth) {
    depth_ = depth;
    force_ = cell_.step({0, 0, kTouch - depth}, kAxis, time_ += kStep);
    if (!force_.valid) ++invalid_;
    smallest_push_ = std::min(smallest_push_, force_.force.dot(kAxis));
  }

  Scene scene_ = coarseScene("st_venant_kirchhoff");
  ExplicitCellModel cell_{scene_, kConfig};
  double depth_ = -2e-6, time_ = 0, smallest_push_ = 0;
  int invalid_ = 0;
  TipForce force_;
};

double equilibriumForce(const Scene& scene, const Vector3d& displacement) {
  const auto cell = std::make_shared<const P1Cell>(scene);
  int hint = 0;
  const auto path = cell->path(cell->contactAt(*cell->touch({0, 0, 30e-6}, kAxis, hint), kAxis));
  IndentationSolution solution;
  do {
    solution = path->follow({displacement, 0, std::nullopt, 0});
  } while (solution.converged && solution.tip_displacement != displacement);
  EXPECT_TRUE(solution.converged) << solution.reason;
  return solution.force.z();
}

class SettledExplicitCellModelTest : public testing::TestWithParam<const char*> {};

TEST_P(SettledExplicitCellModelTest, ComesToRestAtTheEquilibriumOfTheSameMesh) {
  const Scene scene = coarseScene(GetParam());
  ExplicitCellModel cell(scene, kConfig);
  TipForce force;
  double time = 0;
  for (; time < 1; time += kStep) force = cell.step({0, 0, kTouch - 3e-6 * time}, kAxis, time);
  for (; time < 2; time += kStep) force = cell.step({0, 0, kTouch - 3e-6}, kAxis, time);
  ASSERT_TRUE(force.valid) << cell.invalidReason();
  ASSERT_TRUE(cell.contact());
  const double expected = equilibriumForce(scene, cell.contact()->displacement);
  EXPECT_NEAR(force.force.z(), expected, 0.005 * expected) << cell.description();
}
INSTANTIATE_TEST_SUITE_P(Materials, SettledExplicitCellModelTest, testing::Values("st_venant_kirchhoff", "linear"));

TEST_F(ExplicitCellModelTest, ScaledMassMakesAFastNeedleFeelMore) {
  moveTo(0, 0.1);
  const double fast = moveTo(3e-6, 0.02).force.z(), settled = rest(1).force.z();
  EXPECT_GT(fast, 1.02 * settled);
  EXPECT_EQ(invalid_, 0);
}

TEST_F(ExplicitCellModelTest, NeitherPullsNorStaysDeformedWhenTheNeedleLeaves) {
  moveTo(3e-6, 0.5);
  moveTo(-3e-6, 0.1);
  EXPECT_FALSE(cell_.contact());
  EXPECT_EQ(force_.force, Vector3d::Zero().eval());
  rest(3);
  EXPECT_GE(smallest_push_, 0);
  const CellModel::DeformedSurface surface = cell_.deformedSurface();
  EXPECT_LT(*std::max_element(surface.displacement.begin(), surface.displacement.end()), 1e-9);
  EXPECT_TRUE(surface.contact_vertices.empty());
}

TEST_F(ExplicitCellModelTest, DrawsTheDeformationUnderTheTip) {
  moveTo(3e-6, 0.5);
  const CellModel::DeformedSurface surface = cell_.deformedSurface();
  ASSERT_FALSE(surface.contact_vertices.empty());
  for (const std::uint32_t vertex : surface.contact_vertices) EXPECT_NEAR(surface.displacement[vertex], 3e-6, 0.3e-6);
  for (const std::uint32_t vertex : cell_.held()) EXPECT_EQ(surface.displacement[vertex], 0);
}

class FailedExplicitCellModelTest : public ExplicitCellModelTest, public testing::WithParamInterface<double> {};

TEST_P(FailedExplicitCellModelTest, ReportsItAndIsWholeAfterTheNeedleHasLeft) {
  moveTo(2e-6, 0.2);
  moveTo(GetParam(), kStep);
  EXPECT_FALSE(force_.valid);
  rest(0.1);
  EXPECT_FALSE(force_.valid);
  EXPECT_NE(cell_.invalidReason().find("withdraw"), std::string::npos) << cell_.invalidReason();
  moveTo(-3e-6, 0.1);
  EXPECT_EQ(cell_.invalidReason(), "");
  const CellModel::DeformedSurface surface = cell_.deformedSurface();
  EXPECT_LT(*std::max_element(surface.displacement.begin(), surface.displacement.end()), 1e-15);
  invalid_ = 0;
  moveTo(2e-6, 0.5);
  EXPECT_EQ(invalid_, 0);
  EXPECT_GT(force_.force.z(), 0);
}
/// m, of a jump: elements are inverted, or the steps diverge.
INSTANTIATE_TEST_SUITE_P(Jumps, FailedExplicitCellModelTest, testing::Values(30e-6, 60e-6, 200e-6));

TEST_F(ExplicitCellModelTest, ASecondContactOnACellThatStillMovesSettlesToTheSameForce) {
  const double first = settledAt3um();
  moveTo(-1e-6, 0.02);
  moveTo(3e-6, 0.1);
  EXPECT_NEAR(rest(1.5).force.z(), first, 0.01 * first);
}

TEST_F(ExplicitCellModelTest, AHandThatTremblesMeetsTheSameContact) {
  ExplicitCellModel beside(scene_, kConfig);
  TipForce centred, shifted;
  for (double time = 0; time < 1; time += kStep) {
    const double z = kTouch - 2e-6 * time;
    centred = cell_.step({0, 0, z}, kAxis, time);
    shifted = beside.step({10e-9, 5e-9, z}, kAxis, time);
  }
  EXPECT_EQ(beside.deformedSurface().contact_vertices, cell_.deformedSurface().contact_vertices);
  EXPECT_NEAR(shifted.force.z(), centred.force.z(), 0.01 * centred.force.z());
}

TEST_F(ExplicitCellModelTest, APunctureLeavesAnUndeformedCell) {
  moveTo(3e-6, 0.5);
  cell_.release();
  EXPECT_FALSE(cell_.contact());
  const CellModel::DeformedSurface surface = cell_.deformedSurface();
  EXPECT_EQ(*std::max_element(surface.displacement.begin(), surface.displacement.end()), 0);
  EXPECT_TRUE(surface.contact_vertices.empty());
}

TEST_F(ExplicitCellModelTest, ALongHoldWithNoiseStaysStable) {
  moveTo(3e-6, 0.5);
  for (int i = 0; i < 30000; ++i) {
    const double noise = 40e-9 * std::sin(1.0 * i * i);
    cell_.step({0, 0, kTouch - 3e-6 + noise}, kAxis, time_ += kStep);
    ASSERT_EQ(cell_.invalidReason(), "") << i;
  }
}

TEST_F(ExplicitCellModelTest, TimeThatIsMissingIsLeftOut) {
  moveTo(2e-6, 0.5);
  const double settled = rest(1).force.z();
  time_ += 1e6;
  EXPECT_NEAR(rest(0.01).force.z(), settled, 0.01 * settled);
  cell_.step({0, 0, std::numeric_limits<double>::quiet_NaN()}, kAxis, time_);
  EXPECT_NE(cell_.invalidReason(), "");
  EXPECT_NEAR(rest(0.01).force.z(), settled, 0.01 * settled);
}

TEST_F(ExplicitCellModelTest, WhatTheHoldingPipetteHoldsIsNotPushed) {
  const TipForce force = cell_.step({0, 0, -kTouch + 1e-6}, -kAxis, 0);
  EXPECT_FALSE(force.valid);
  EXPECT_NE(cell_.invalidReason().find("holding pipette"), std::string::npos) << cell_.invalidReason();
}

TEST_F(ExplicitCellModelTest, RefusesWhatTheDynamicsDoesNotHave) {
  EXPECT_THROW(ExplicitCellModel(coarseScene("neo_hookean"), {}), ConfigError);
  Scene layered = scene_;
  layered.cell.layers.push_back(layered.cell.layers.front());
  EXPECT_THROW(ExplicitCellModel(layered, {}), ConfigError);
}

}  // namespace
}  // namespace microinjection
