#include "cell/model/indentation.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "base/finite_difference.h"

namespace microinjection {
namespace {

using Eigen::Vector3d;

/// The mouse oocyte (Table I) on a coarse mesh.
class IndentationTest : public testing::Test {
 protected:
  static std::shared_ptr<const P1Cell> makeCell(const std::string& model, double size = 20e-6) {
    Scene scene;
    scene.cell.material().model = model;
    scene.mesh.size = size;
    return std::make_shared<const P1Cell>(scene);
  }

  static Indentation makeIndentation(const std::string& model, double size = 20e-6) {
    const std::shared_ptr<const P1Cell> cell = makeCell(model, size);
    return Indentation(cell, cell->patchAt({0, 0, cell->scene().radius()}, Vector3d::UnitZ()));
  }
};

TEST_F(IndentationTest, UndeformedHasNoForceAndThePolesStiffness) {
  for (const std::string& model : materialModels()) {
    Indentation indentation = makeIndentation(model);
    const IndentationSolution solution = indentation.solve(Vector3d::Zero());
    EXPECT_TRUE(solution.converged);
    EXPECT_EQ(solution.force.norm(), 0);
    EXPECT_EQ(solution.newton_iterations, 0);
    EXPECT_EQ(solution.smallest_jacobian, 1);
    EXPECT_EQ(solution.stiffness, solution.stiffness.transpose());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(solution.stiffness).eigenvalues()[0], 0);
    // The same at small strain, whatever the material.
    EXPECT_NEAR(solution.stiffness(2, 2), makeIndentation("linear").solve(Vector3d::Zero()).stiffness(2, 2), 1e-10);
  }
}

TEST_F(IndentationTest, LinearCellIsProportionalAtAnyDepth) {
  Indentation indentation = makeIndentation("linear");
  const Eigen::Matrix3d stiffness = indentation.solve(Vector3d::Zero()).stiffness;
  for (const Vector3d& tip : {Vector3d(0, 0, -1e-9), Vector3d(1e-6, -2e-6, -3e-6), Vector3d(0, 0, -45e-6)}) {
    const IndentationSolution solution = indentation.solve(tip);
    EXPECT_TRUE(solution.converged);
    EXPECT_EQ(solution.tip_displacement, tip);
    EXPECT_LT((solution.force + stiffness * tip).norm(), 1e-8 * solution.force.norm());
  }
}

TEST_F(IndentationTest, ForceOpposesTheIndentation) {
  for (const std::string& model : materialModels()) {
    const IndentationSolution solution = makeIndentation(model).solve({0, 0, -1e-6});
    EXPECT_TRUE(solution.converged) << solution.reason;
    EXPECT_GT(solution.force.z(), 0.1e-6);
    EXPECT_LT(solution.force.head<2>().norm(), 0.05 * solution.force.z());
    EXPECT_LT(solution.smallest_jacobian, 1);
  }
}

TEST_F(IndentationTest, StiffnessIsTheDerivativeOfTheForceWhenDeep) {
  Indentation indentation = makeIndentation("neo_hookean");
  const Vector3d tip(1e-6, 0.5e-6, -5e-6);
  const IndentationSolution deep = indentation.solve(tip);
  ASSERT_TRUE(deep.converged) << deep.reason;
  const auto force = [&](const Eigen::VectorXd& at) {
    const IndentationSolution solution = indentation.solve(at);
    EXPECT_TRUE(solution.converged) << solution.reason;
    return Eigen::VectorXd(solution.force);
  };
  EXPECT_LT(derivativeError(force, tip, -deep.stiffness, 5e-9), 1e-5);
}

TEST_F(IndentationTest, PatchMovesByTheTipAndTheHeldVerticesStay) {
  const std::shared_ptr<const P1Cell> cell = makeCell("neo_hookean");
  const TipPatch patch = cell->patchAt({0, 0, 28e-6}, Vector3d::UnitZ());
  Indentation indentation(cell, patch);
  const Vector3d tip(0.5e-6, 0, -4e-6);
  ASSERT_TRUE(indentation.solve(tip).converged);
  for (int v : patch.vertices) EXPECT_LT((indentation.state().segment<3>(3 * v) - tip).norm(), 1e-18);
  for (int v : cell->heldVertices()) EXPECT_EQ(indentation.state().segment<3>(3 * v).norm(), 0);
}

TEST_F(IndentationTest, NeoHookeanGoesDeepAndComesBack) {
  Indentation indentation = makeIndentation("neo_hookean");
  double last = 0;
  for (const double depth : {1e-6, 5e-6, 10e-6, 20e-6}) {
    const IndentationSolution solution = indentation.solve({0, 0, -depth});
    ASSERT_TRUE(solution.converged) << depth << ": " << solution.reason;
    EXPECT_GT(solution.force.z(), last);
    EXPECT_GT(solution.smallest_jacobian, 0);
    last = solution.force.z();
  }
  const IndentationSolution back = indentation.solve(Vector3d::Zero());
  ASSERT_TRUE(back.converged) << back.reason;
  EXPECT_LT(back.force.norm(), 1e-6 * last);
}

TEST_F(IndentationTest, LostBranchOfStVenantKirchhoffIsSaidAndTheStateStays) {
  Indentation indentation = makeIndentation("st_venant_kirchhoff");
  ASSERT_TRUE(indentation.solve({0, 0, -1e-6}).converged);
  const IndentationSolution lost = indentation.solve({0, 0, -20e-6});
  EXPECT_FALSE(lost.converged);
  EXPECT_FALSE(lost.reason.empty());
  EXPECT_LT(lost.tip_displacement.z(), -2e-6);
  EXPECT_GT(lost.tip_displacement.z(), -20e-6);
  EXPECT_GT(lost.smallest_jacobian, 0);
  EXPECT_GE(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(lost.stiffness).eigenvalues()[1], 0);

  const IndentationSolution there = indentation.solve(lost.tip_displacement);  // is where it stopped
  EXPECT_TRUE(there.converged);
  EXPECT_EQ(there.newton_iterations, 0);
  EXPECT_EQ(there.force, lost.force);

  const IndentationSolution shallower = indentation.solve({0, 0, -1e-6});
  ASSERT_TRUE(shallower.converged) << shallower.reason;
  const IndentationSolution fresh = makeIndentation("st_venant_kirchhoff").solve({0, 0, -1e-6});
  EXPECT_NEAR(shallower.force.z(), fresh.force.z(), 1e-7 * fresh.force.z());
}

TEST_F(IndentationTest, TwoRunsGiveTheSameBits) {
  Indentation one = makeIndentation("neo_hookean"), two = makeIndentation("neo_hookean");
  for (const double depth : {0.3e-6, 2e-6, 6e-6, 1e-6}) {
    const IndentationSolution a = one.solve({0.1e-6, 0, -depth}), b = two.solve({0.1e-6, 0, -depth});
    EXPECT_EQ(a.force, b.force);
    EXPECT_EQ(a.stiffness, b.stiffness);
    EXPECT_EQ(one.state(), two.state());
  }
}

TEST_F(IndentationTest, AMovingNeedleTakesFewIterations) {
  Indentation indentation = makeIndentation("neo_hookean");
  ASSERT_TRUE(indentation.solve({0, 0, -5e-6}).converged);
  for (int i = 1; i <= 5; ++i) {
    const IndentationSolution solution = indentation.solve({0, 0, -5e-6 - 0.02e-6 * i});  // 0.6 um/s at 30 Hz
    EXPECT_TRUE(solution.converged);
    EXPECT_LE(solution.newton_iterations, 3);
  }
}

TEST_F(IndentationTest, ASofterCoreMakesTheCellSofter) {
  const auto force = [](double core_modulus) {
    Scene scene;
    scene.mesh.size = 15e-6;
    scene.cell.layers.push_back(scene.cell.layers.front());
    scene.cell.layers.back().name = "core";
    scene.cell.layers.back().outer_radius = 20e-6;
    scene.cell.layers.back().material.young_modulus = core_modulus;
    const auto cell = std::make_shared<const P1Cell>(scene);
    const IndentationSolution solution =
        Indentation(cell, cell->patchAt({0, 0, 28e-6}, Vector3d::UnitZ())).solve({0, 0, -3e-6});
    EXPECT_TRUE(solution.converged) << solution.reason;
    return solution.force.z();
  };
  const double homogeneous = force(17.9e3), soft = force(1e3);
  EXPECT_LT(soft, 0.9 * homogeneous);
  EXPECT_GT(soft, 0.2 * homogeneous);
}

TEST_F(IndentationTest, ThreadsShareACell) {
  const std::shared_ptr<const P1Cell> cell = makeCell("neo_hookean");
  const TipPatch patch = cell->patchAt({0, 0, 28e-6}, Vector3d::UnitZ());
  const auto push = [&](IndentationSolution& solution) {
    Indentation indentation(cell, patch);
    for (int i = 1; i <= 10; ++i) solution = indentation.solve({0, 0, -0.5e-6 * i});
    indentation.reset();
    solution = indentation.solve({0, 0, -2e-6});
  };
  IndentationSolution alone, one, other;
  push(alone);
  std::thread first([&] { push(one); }), second([&] { push(other); });
  first.join();
  second.join();
  EXPECT_EQ(one.force, alone.force);
  EXPECT_EQ(other.force, alone.force);
  EXPECT_EQ(other.stiffness, alone.stiffness);
}

TEST_F(IndentationTest, RefusesAPatchOnTheHeldVertices) {
  const std::shared_ptr<const P1Cell> cell = makeCell("linear");
  TipPatch patch;
  patch.vertices = {cell->heldVertices().front()};
  EXPECT_THROW(Indentation(cell, patch), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
