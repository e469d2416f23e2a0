#include "mechanics/patch_system.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <stdexcept>

#include "mesh/shapes.h"

namespace microinjection {
namespace {

/// A cube held at its bottom and moved at its top.
class PatchSystemTest : public testing::Test {
 protected:
  static std::vector<int> layer(const TetMesh& mesh, double z) {
    std::vector<int> vertices;
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (mesh.vertices[v].z() == z) vertices.push_back(static_cast<int>(v));
    }
    return vertices;
  }

  const TetMesh mesh_ = unitCube(3);
  const ElasticBody body_{mesh_, makeMaterial({"neo_hookean", 2.0, 0.3})};
  const std::vector<int> held_ = layer(mesh_, 0), patch_ = layer(mesh_, 1);
  PatchSystem system_{body_, held_, patch_};
};

TEST_F(PatchSystemTest, CondensedStiffnessIsThatOfTheDenseSystem) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * body_.vertexCount());
  system_.addTo(u, Eigen::VectorXd::Zero(system_.freeSize()), {0.02, 0, -0.05});
  ASSERT_TRUE(system_.factorise(u));

  // The same, dense and unordered: all unknowns, then constraints by a projection Q.
  const Eigen::Index size = u.size();
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  ElasticBody::ElementMatrix element;
  for (int e = 0; e < body_.elementCount(); ++e) {
    body_.elementStiffness(e, u, element);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        K.block<3, 3>(3 * body_.corners(e)[a], 3 * body_.corners(e)[b]) += element.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  const Eigen::Index free = system_.freeSize();
  Eigen::MatrixXd Q(size, free + 3);
  for (Eigen::Index i = 0; i < free + 3; ++i) {
    Eigen::VectorXd column = Eigen::VectorXd::Zero(size);
    const Eigen::VectorXd unit = Eigen::VectorXd::Unit(free + 3, i);
    system_.addTo(column, unit.head(free), unit.tail<3>());
    Q.col(i) = column;
  }
  const Eigen::MatrixXd reduced = Q.transpose() * K * Q;
  const Eigen::MatrixXd K_ff = reduced.topLeftCorner(free, free), K_ft = reduced.topRightCorner(free, 3);
  const Eigen::Matrix3d condensed = reduced.bottomRightCorner<3, 3>() - K_ft.transpose() * K_ff.ldlt().solve(K_ft);
  EXPECT_LT((system_.stiffness() - condensed).norm(), 1e-12 * condensed.norm());
  EXPECT_LT((system_.sensitivity() + K_ff.ldlt().solve(K_ft)).norm(), 1e-11 * system_.sensitivity().norm());
  const Eigen::MatrixXd sparse = Eigen::MatrixXd(system_.matrix()).selfadjointView<Eigen::Lower>();
  EXPECT_LT((sparse - K_ff).norm(), 1e-13 * K_ff.norm());
}

TEST_F(PatchSystemTest, ResidualCollectsFreeForcesAndTheReaction) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(3 * body_.vertexCount());
  system_.addTo(u, Eigen::VectorXd::Zero(system_.freeSize()), {0, 0, -0.05});
  Eigen::VectorXd force, free;
  Eigen::Vector3d reaction, expected = Eigen::Vector3d::Zero();
  body_.internalForce(u, force);
  system_.residual(u, free, reaction);
  for (int v : patch_) expected += force.segment<3>(3 * v);
  EXPECT_EQ(reaction, expected);
  EXPECT_LT(reaction.z(), 0);  // what holds the patch down
  double held = 0;
  for (int v : held_) held += force.segment<3>(3 * v).squaredNorm();
  double patch = 0;
  for (int v : patch_) patch += force.segment<3>(3 * v).squaredNorm();
  EXPECT_NEAR(free.squaredNorm() + held + patch, force.squaredNorm(), 1e-13 * force.squaredNorm());
}

TEST_F(PatchSystemTest, TangentOfACrushedStVenantKirchhoffIsNotPositiveDefinite) {
  const ElasticBody soft(mesh_, makeMaterial({"st_venant_kirchhoff", 2.0, 0.3}));
  PatchSystem system(soft, held_, patch_);
  Eigen::VectorXd u(3 * soft.vertexCount());
  for (int v = 0; v < soft.vertexCount(); ++v)
    u.segment<3>(3 * v) = Eigen::Vector3d(0, 0, -0.6 * mesh_.vertices[v].z());
  EXPECT_TRUE(system.factorise(Eigen::VectorXd::Zero(u.size())));
  EXPECT_FALSE(system.factorise(u));
  EXPECT_TRUE(system.factorise(Eigen::VectorXd::Zero(u.size())));  // and it recovers
}

TEST_F(PatchSystemTest, RefusesOverlapAndNothingFree) {
  EXPECT_THROW(PatchSystem(body_, held_, held_), std::invalid_argument);
  std::vector<int> all;
  for (int v = 0; v < body_.vertexCount(); ++v) all.push_back(v);
  EXPECT_THROW(PatchSystem(body_, all, {}), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
