#include "mechanics/equilibrium_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "base/finite_difference.h"
#include "mesh/shapes.h"

namespace microinjection {
namespace {

/// A unit cube held at its bottom; its whole top moves. nu = 0.3.
class EquilibriumPathTest : public testing::Test {
 protected:
  static std::vector<int> layer(const TetMesh& mesh, double z) {
    std::vector<int> vertices;
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (mesh.vertices[v].z() == z) vertices.push_back(static_cast<int>(v));
    }
    return vertices;
  }

  ElasticBody body(const std::string& model, double nu = 0.3) const {
    return ElasticBody(mesh_, makeMaterial({model, 2.0, nu}));
  }

  EquilibriumPath path(const ElasticBody& body) const {
    return EquilibriumPath(body, layer(mesh_, 0), layer(mesh_, 1), 1);
  }

  const TetMesh mesh_ = unitCube(3);
};

TEST_F(EquilibriumPathTest, UniformCompressionIsExact) {
  // nu = 0: nothing moves sideways, so that the cube is in uniaxial strain, and F is diag(1, 1, s).
  const Eigen::Vector3d target(0, 0, -0.3);
  const double s = 0.7;
  const std::vector<std::pair<std::string, double>> expected = {
      {"linear", 2 * (s - 1)}, {"st_venant_kirchhoff", s * (s * s - 1)}, {"neo_hookean", s - 1 / s}};
  for (const auto& [model, stress] : expected) {
    const ElasticBody cube = body(model, 0);
    EquilibriumPath along = path(cube);
    const EquilibriumPath::Result result = along.advance(target);
    ASSERT_TRUE(result.converged) << model << ": " << result.reason;
    EXPECT_EQ(along.translation(), target);
    EXPECT_NEAR(along.reaction().z(), stress, 1e-9) << model;
    EXPECT_NEAR(along.reaction().head<2>().norm(), 0, 1e-9) << model;
    EXPECT_NEAR(along.smallestJacobian(), s, 1e-9) << model;
  }
}

TEST_F(EquilibriumPathTest, StiffnessIsTheDerivativeOfTheReactionHenceReciprocal) {
  const ElasticBody cube = body("neo_hookean");
  EquilibriumPath along = path(cube);
  const Eigen::Vector3d point(0.1, -0.05, -0.2);
  ASSERT_TRUE(along.advance(point).converged);
  const Eigen::Matrix3d stiffness = along.stiffness();
  EXPECT_EQ(stiffness, stiffness.transpose());
  const auto reaction = [&](const Eigen::VectorXd& at) {
    EXPECT_TRUE(along.advance(at).converged);
    return Eigen::VectorXd(along.reaction());
  };
  EXPECT_LT(derivativeError(reaction, point, stiffness, 1e-4), 1e-6);
}

TEST_F(EquilibriumPathTest, ReactionIsTheDerivativeOfTheEnergyAndTheWayBackIsTheSame) {
  const ElasticBody cube = body("neo_hookean");
  EquilibriumPath along = path(cube);
  const Eigen::Vector3d point(0.1, -0.05, -0.2);
  ASSERT_TRUE(along.advance(point).converged);
  const Eigen::Vector3d reaction = along.reaction();
  const Eigen::VectorXd u = along.displacement();
  const auto energy = [&](const Eigen::VectorXd& at) {
    EXPECT_TRUE(along.advance(at).converged);
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, along.energy()));
  };
  EXPECT_LT(derivativeError(energy, point, reaction.transpose(), 1e-4), 1e-6);
  ASSERT_TRUE(along.advance(Eigen::Vector3d::Zero()).converged);
  EXPECT_LT(along.reaction().norm(), 1e-9 * reaction.norm());
  EXPECT_LT(along.displacement().norm(), 1e-9 * u.norm());
  ASSERT_TRUE(along.advance(point).converged);
  EXPECT_LT((along.displacement() - u).norm(), 1e-8 * u.norm());
}

TEST_F(EquilibriumPathTest, StVenantKirchhoffEndsWhereTheStableBranchDoes) {
  // Uniaxial strain at nu = 0: P = s (s^2 - 1) has its extremum, and the bar its last stable state, at s = 1 / sqrt(3).
  const ElasticBody cube = body("st_venant_kirchhoff", 0);
  EquilibriumPath along = path(cube);
  const EquilibriumPath::Result result = along.advance({0, 0, -0.9});
  EXPECT_FALSE(result.converged);
  EXPECT_FALSE(result.reason.empty());
  const double s = 1 + along.translation().z();
  EXPECT_GT(s, 1 / std::sqrt(3.0) - 1e-3);  // never beyond
  EXPECT_LT(s, 0.7);
  EXPECT_NEAR(along.reaction().z(), s * (s * s - 1), 1e-8);  // and a right state where it stopped

  ASSERT_TRUE(along.advance({0, 0, -0.2}).converged);  // from where one can go back
  EXPECT_NEAR(along.reaction().z(), 0.8 * (0.64 - 1), 1e-8);
}

TEST_F(EquilibriumPathTest, NothingToDoIsUndeformed) {
  const ElasticBody cube = body("neo_hookean");
  EquilibriumPath along = path(cube);
  const EquilibriumPath::Result result = along.advance(Eigen::Vector3d::Zero());
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.newton_iterations, 0);
  EXPECT_EQ(along.reaction().norm(), 0);
  EXPECT_GT(along.stiffness()(2, 2), 0);
}

TEST_F(EquilibriumPathTest, ResetForgets) {
  const ElasticBody cube = body("neo_hookean");
  EquilibriumPath one = path(cube), two = path(cube);
  ASSERT_TRUE(one.advance({0.2, 0, -0.3}).converged);
  one.reset();
  ASSERT_TRUE(one.advance({0, 0, -0.1}).converged);
  ASSERT_TRUE(two.advance({0, 0, -0.1}).converged);
  EXPECT_EQ(one.displacement(), two.displacement());  // to the bit
  EXPECT_EQ(one.reaction(), two.reaction());
}

}  // namespace
}  // namespace microinjection
