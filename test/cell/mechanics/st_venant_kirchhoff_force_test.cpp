#include "cell/mechanics/st_venant_kirchhoff_force.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/finite_difference.h"
#include "cell/mechanics/bodies.h"
#include "cell/mechanics/tetrahedra.h"

namespace microinjection {
namespace {

Eigen::VectorXd forceOf(StVenantKirchhoffForce& force, const Eigen::VectorXd& positions) {
  Eigen::VectorXd result = Eigen::VectorXd::Constant(positions.size(), std::numeric_limits<double>::quiet_NaN());
  force.evaluate(positions.data(), result.data());
  return result;
}

Eigen::VectorXd forceOf(const TetMesh& mesh, const Eigen::VectorXd& positions) {
  StVenantKirchhoffForce force(mesh, Lame::from(kYoung, kPoisson));
  return forceOf(force, positions);
}

/// J, from the definition.
double energyOf(const TetMesh& mesh, const Eigen::VectorXd& positions) {
  const Lame lame = Lame::from(kYoung, kPoisson);
  double energy = 0;
  for (const auto& corner : mesh.tetrahedra) {
    Eigen::Matrix3d rest, deformed;
    for (int a = 0; a < 3; ++a) {
      rest.col(a) = mesh.vertices[corner[a + 1]] - mesh.vertices[corner[0]];
      deformed.col(a) = positions.segment<3>(3 * corner[a + 1]) - positions.segment<3>(3 * corner[0]);
    }
    const Eigen::Matrix3d F = deformed * rest.inverse();
    const Eigen::Matrix3d E = (F.transpose() * F - Eigen::Matrix3d::Identity()) / 2;
    const double density = lame.lambda / 2 * E.trace() * E.trace() + lame.mu * E.squaredNorm();
    energy += rest.determinant() / 6 * density;
  }
  return energy;
}

TEST(StVenantKirchhoffForce, IsThatOfTheElements) {
  const TetMesh mesh = irregularMesh();
  const auto body = makeBody(irregularBlock<3>(3), ElementKind::kP1, "st_venant_kirchhoff", kPoisson);
  Eigen::VectorXd state = Eigen::VectorXd::Zero(body->stateSize());
  const Eigen::VectorXd displacement = randomVector(3 * static_cast<Eigen::Index>(mesh.vertices.size()), 0.04);
  state.head(displacement.size()) = displacement;
  const Eigen::VectorXd expected = -gradientOf(*body, state).head(displacement.size());
  EXPECT_GT(expected.norm(), 0.1);
  EXPECT_LT((forceOf(mesh, places(mesh) + displacement) - expected).norm(), 1e-12 * expected.norm());
}

TEST(StVenantKirchhoffForce, IsMinusTheEnergysDerivativeInvertedOrNot) {
  const TetMesh mesh = irregularMesh();
  for (const double amplitude : {0.04, 0.5}) {
    const Eigen::VectorXd at = places(mesh) + randomVector(places(mesh).size(), amplitude);
    const auto energy = [&](const Eigen::VectorXd& positions) {
      return Eigen::VectorXd(Eigen::VectorXd::Constant(1, energyOf(mesh, positions)));
    };
    EXPECT_LT(derivativeError(energy, at, -forceOf(mesh, at).transpose(), 1e-5), 1e-7);
  }
}

TEST(StVenantKirchhoffForce, RigidMotionGivesNone) {
  const TetMesh mesh = irregularMesh();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  Eigen::VectorXd positions = places(mesh);
  for (Eigen::Index v = 0; v < positions.size() / 3; ++v) {
    positions.segment<3>(3 * v) = R * mesh.vertices[v] + Eigen::Vector3d(1, 2, -3);
  }
  EXPECT_LT(forceOf(mesh, positions).cwiseAbs().maxCoeff(), 1e-13 * kYoung);  // the block is of size 1
}

TEST(StVenantKirchhoffForce, EveryInstructionSetGivesTheSame) {
  const TetMesh mesh = irregularMesh();
  const Eigen::VectorXd at = places(mesh) + randomVector(places(mesh).size(), 0.04);
  const Lame lame = Lame::from(kYoung, kPoisson);
  StVenantKirchhoffForce baseline(mesh, lame, InstructionSet::kBaseline);
  const Eigen::VectorXd expected = forceOf(baseline, at);
  const std::vector<InstructionSet> sets = supportedInstructionSets();
  ASSERT_EQ(sets.front(), InstructionSet::kBaseline);
  for (const InstructionSet set : sets) {
    SCOPED_TRACE(instructionSetName(set));
    StVenantKirchhoffForce force(mesh, lame, set);
    EXPECT_EQ(force.instructionSet(), set);
    const Eigen::VectorXd found = forceOf(force, at);
    EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-14 * expected.cwiseAbs().maxCoeff() * 10);
    EXPECT_EQ(forceOf(force, at), found);  // nothing stays from the call before
  }
  EXPECT_EQ(StVenantKirchhoffForce(mesh, lame).instructionSet(), sets.back());
  for (const InstructionSet set : {InstructionSet::kAvx2, InstructionSet::kAvx512}) {
    if (std::find(sets.begin(), sets.end(), set) == sets.end()) {
      EXPECT_THROW(StVenantKirchhoffForce(mesh, lame, set), std::invalid_argument);
    }
  }
}

TEST(StVenantKirchhoffForce, IsInTheOrderOfTheMesh) {
  TetMesh mesh = irregularMesh();
  const Eigen::VectorXd at = places(mesh) + randomVector(places(mesh).size(), 0.04);
  const Eigen::VectorXd expected = forceOf(mesh, at);
  const int count = static_cast<int>(mesh.vertices.size());
  TetMesh turned = mesh;
  turned.vertices.emplace_back(0, 0, 0);  // of no tetrahedron
  for (int v = 0; v < count; ++v) turned.vertices[count - v] = mesh.vertices[v];
  turned.vertices[0] = {5, 5, 5};
  for (auto& corners : turned.tetrahedra) {
    for (int& vertex : corners) vertex = count - vertex;
  }
  Eigen::VectorXd moved = places(turned);
  for (int v = 0; v < count; ++v) moved.segment<3>(3 * (count - v)) = at.segment<3>(3 * v);
  const Eigen::VectorXd found = forceOf(turned, moved);
  EXPECT_EQ(found.head<3>().norm(), 0);
  for (int v = 0; v < count; ++v) {
    EXPECT_LT((found.segment<3>(3 * (count - v)) - expected.segment<3>(3 * v)).norm(), 1e-13 * expected.norm());
  }
}

void expectRefused(const TetMesh& mesh, const Lame& lame, const std::string& why) {
  try {
    StVenantKirchhoffForce(mesh, lame).vertexCount();
    FAIL() << "no error: " << why;
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
  }
}

TEST(StVenantKirchhoffForce, RefusesBadMeshesAndModuli) {
  const TetMesh good = irregularMesh();
  const Lame lame = Lame::from(kYoung, kPoisson);
  TetMesh mesh = good;
  std::swap(mesh.tetrahedra[7][0], mesh.tetrahedra[7][1]);
  expectRefused(mesh, lame, "tetrahedron 7 is inverted");
  mesh = good;
  mesh.tetrahedra[5][3] = mesh.tetrahedra[5][2];
  expectRefused(mesh, lame, "tetrahedron 5 is flat");
  for (const int vertex : {-1, 64, 1 << 30}) {
    mesh = good;
    mesh.tetrahedra[3][1] = vertex;
    expectRefused(mesh, lame, "tetrahedron 3 names vertex " + std::to_string(vertex) + ", but there are 64");
  }
  mesh = good;
  mesh.vertices[9].y() = std::numeric_limits<double>::quiet_NaN();
  expectRefused(mesh, lame, "vertex 9 is not finite");
  expectRefused(good, {1, 0}, "mu > 0");
  expectRefused(good, {-1, 1}, "3 lambda + 2 mu > 0");
  TetMesh empty;
  empty.vertices = good.vertices;
  EXPECT_EQ(forceOf(empty, places(empty)).norm(), 0);
}

}  // namespace
}  // namespace microinjection
