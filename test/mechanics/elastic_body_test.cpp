#include "mechanics/elastic_body.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>
#include <stdexcept>

#include "base/finite_difference.h"
#include "mechanics/patch_system.h"
#include "mesh/shapes.h"
#include "mesh/surface_mesh.h"

namespace microinjection {
namespace {

constexpr double kYoung = 2.0;  // Pa

class ElasticBodyTest : public testing::TestWithParam<std::string> {
 protected:
  static Eigen::VectorXd random(Eigen::Index size, double amplitude) {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> entry(-amplitude, amplitude);
    return Eigen::VectorXd::NullaryExpr(size, [&] { return entry(generator); });
  }

  /// A cube whose inner vertices are off the grid.
  static TetMesh distortedCube() {
    TetMesh mesh = unitCube(3);
    const Eigen::VectorXd shift = random(3 * static_cast<Eigen::Index>(mesh.vertices.size()), 0.05);
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
      const bool inner = mesh.vertices[v].minCoeff() > 0 && mesh.vertices[v].maxCoeff() < 1;
      if (inner) mesh.vertices[v] += shift.segment<3>(3 * v);
    }
    return mesh;
  }

  const TetMesh mesh_ = distortedCube();
  const ElasticBody body_{mesh_, makeMaterial({GetParam(), kYoung, 0.3})};
  const Eigen::Index size_ = 3 * body_.vertexCount();
};

TEST_P(ElasticBodyTest, ForceIsTheDerivativeOfTheEnergy) {
  const Eigen::VectorXd u = random(size_, 0.02);
  Eigen::VectorXd force;
  body_.internalForce(u, force);
  const auto energy = [&](const Eigen::VectorXd& at) {
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, body_.energy(at)));
  };
  EXPECT_LT(derivativeError(energy, u, force.transpose(), 1e-6), 1e-6);
}

TEST_P(ElasticBodyTest, StiffnessIsTheDerivativeOfTheForce) {
  const Eigen::VectorXd u = random(size_, 0.02);
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(size_, size_);
  ElasticBody::ElementMatrix element;
  for (int e = 0; e < body_.elementCount(); ++e) {
    body_.elementStiffness(e, u, element);
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        stiffness.block<3, 3>(3 * body_.corners(e)[a], 3 * body_.corners(e)[b]) += element.block<3, 3>(3 * a, 3 * b);
      }
    }
  }
  const auto force = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd result;
    body_.internalForce(at, result);
    return result;
  };
  EXPECT_LT(derivativeError(force, u, stiffness, 1e-6), 1e-6);
}

TEST_P(ElasticBodyTest, InternalForcesBalance) {
  const Eigen::VectorXd u = random(size_, 0.02);
  Eigen::VectorXd force;
  body_.internalForce(u, force);
  const Eigen::Vector3d sum = force.reshaped(3, body_.vertexCount()).rowwise().sum();
  EXPECT_LT(sum.norm(), 1e-13 * force.norm());
}

/// Patch test: with the boundary displaced by u = (F - I) X the inner vertices must follow exactly, whatever the mesh.
TEST_P(ElasticBodyTest, AffineBoundaryGivesUniformDeformation) {
  Eigen::Matrix3d F;
  F << 1.10, 0.05, -0.03, 0.02, 0.95, 0.04, -0.06, 0.01, 1.07;
  const std::vector<int> boundary = extractSurface(mesh_).mesh_vertices;
  PatchSystem system(body_, boundary, {});
  Eigen::VectorXd exact(size_), u = Eigen::VectorXd::Zero(size_);
  for (int v = 0; v < body_.vertexCount(); ++v) exact.segment<3>(3 * v) = F * mesh_.vertices[v] - mesh_.vertices[v];
  for (int v : boundary) u.segment<3>(3 * v) = exact.segment<3>(3 * v);
  Eigen::VectorXd residual;
  Eigen::Vector3d unused;
  for (int iteration = 0; iteration < 8; ++iteration) {
    system.residual(u, residual, unused);
    ASSERT_TRUE(system.factorise(u));
    system.addTo(u, -system.solve(residual), Eigen::Vector3d::Zero());
  }
  EXPECT_LT((u - exact).norm(), 1e-13 * exact.norm());
  const Eigen::Matrix3d stress = body_.material().stress(F);
  for (int e = 0; e < body_.elementCount(); ++e) {
    EXPECT_LT((body_.material().stress(body_.deformationGradient(e, u)) - stress).norm(), 1e-11 * stress.norm());
  }
  EXPECT_NEAR(body_.energy(u), body_.material().energyDensity(F), 1e-12);  // of the unit cube
}

INSTANTIATE_TEST_SUITE_P(All, ElasticBodyTest, testing::ValuesIn(materialModels()),
                         [](const auto& instance) { return instance.param; });

TEST(ElasticBody, SmallestJacobianFindsTheInvertedElement) {
  const TetMesh mesh = unitCube(1);
  const ElasticBody body(mesh, makeMaterial({"neo_hookean", kYoung, 0.3}));
  Eigen::VectorXd u = Eigen::VectorXd::Zero(24);
  EXPECT_DOUBLE_EQ(body.smallestJacobian(u), 1);
  u[2] = 2;  // the corner at the origin, pushed through the cube
  EXPECT_LT(body.smallestJacobian(u), 0);
  EXPECT_TRUE(std::isinf(body.energy(u)));
}

TEST(ElasticBody, RefusesInvertedElements) {
  TetMesh mesh = unitCube(1);
  std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  EXPECT_THROW(ElasticBody(mesh, makeMaterial({})), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
