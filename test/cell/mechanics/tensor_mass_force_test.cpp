#include "cell/mechanics/tensor_mass_force.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <stdexcept>

#include "base/finite_difference.h"
#include "cell/mechanics/bodies.h"
#include "cell/mechanics/st_venant_kirchhoff_force.h"
#include "cell/mechanics/tetrahedra.h"

namespace microinjection {
namespace {

using Kind = TensorMassForce::Kind;

const Lame kLame = Lame::from(kYoung, kPoisson);

Eigen::VectorXd forceOf(const TetMesh& mesh, Kind kind, const Eigen::VectorXd& displacements) {
  Eigen::VectorXd result = Eigen::VectorXd::Constant(displacements.size(), std::numeric_limits<double>::quiet_NaN());
  TensorMassForce(mesh, kLame, kind).evaluate(displacements.data(), result.data());
  return result;
}

/// J, from the definition: the Green-Lagrange strain, or the small one.
double energyOf(const TetMesh& mesh, Kind kind, const Eigen::VectorXd& displacements) {
  double energy = 0;
  for (const auto& corner : mesh.tetrahedra) {
    Eigen::Matrix3d rest, moved;
    for (int a = 0; a < 3; ++a) {
      rest.col(a) = mesh.vertices[corner[a + 1]] - mesh.vertices[corner[0]];
      moved.col(a) = displacements.segment<3>(3 * corner[a + 1]) - displacements.segment<3>(3 * corner[0]);
    }
    const Eigen::Matrix3d H = moved * rest.inverse();
    Eigen::Matrix3d E = (H + H.transpose()) / 2;
    if (kind == Kind::kStVenantKirchhoff) E += H.transpose() * H / 2;
    energy += rest.determinant() / 6 * (kLame.lambda / 2 * E.trace() * E.trace() + kLame.mu * E.squaredNorm());
  }
  return energy;
}

TEST(TensorMassForce, IsMinusTheEnergysDerivative) {
  const TetMesh mesh = irregularMesh();
  for (const Kind kind : {Kind::kLinear, Kind::kStVenantKirchhoff}) {
    for (const double amplitude : {0.04, 0.5}) {
      const Eigen::VectorXd at = randomVector(places(mesh).size(), amplitude);
      const auto energy = [&](const Eigen::VectorXd& displacements) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, energyOf(mesh, kind, displacements)));
      };
      EXPECT_LT(derivativeError(energy, at, -forceOf(mesh, kind, at).transpose(), 1e-5), 1e-7);
    }
  }
}

TEST(TensorMassForce, IsThatOfTheElementsAndOfTheKernel) {
  const TetMesh mesh = irregularMesh();
  const Eigen::VectorXd displacement = randomVector(places(mesh).size(), 0.04);
  for (const Kind kind : {Kind::kLinear, Kind::kStVenantKirchhoff}) {
    const auto body = makeBody(irregularBlock<3>(3), ElementKind::kP1,
                               kind == Kind::kLinear ? "linear" : "st_venant_kirchhoff", kPoisson);
    Eigen::VectorXd state = Eigen::VectorXd::Zero(body->stateSize());
    state.head(displacement.size()) = displacement;
    const Eigen::VectorXd expected = -gradientOf(*body, state).head(displacement.size());
    const Eigen::VectorXd found = forceOf(mesh, kind, displacement);
    EXPECT_GT(expected.norm(), 0.1);
    EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
    if (kind == Kind::kLinear) continue;
    Eigen::VectorXd kernel(found.size());
    const Eigen::VectorXd positions = places(mesh) + displacement;
    StVenantKirchhoffForce(mesh, kLame).evaluate(positions.data(), kernel.data());
    EXPECT_LT((found - kernel).norm(), 1e-12 * kernel.norm());
  }
}

/// The tensors of one tetrahedron as the docstring and the paper's equation (11) have them, over all four corners.
TEST(TetrahedronTensors, GiveEnergyAndForceAsPrinted) {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 0.9, -0.1}, {0.1, 0.3, 1.2}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  const TetrahedronTensors tensors(mesh, 0, kLame);
  const Eigen::VectorXd at = randomVector(12, 0.4);
  const auto u = [&](int i) -> Eigen::Vector3d { return at.segment<3>(3 * i); };
  double energy = 0;
  Eigen::VectorXd force = Eigen::VectorXd::Zero(12);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      energy += u(i).dot(tensors.K(i, j) * u(j)) / 2;
      force.segment<3>(3 * i) += tensors.K(i, j) * u(j);
      for (int k = 0; k < 4; ++k) {
        energy += tensors.C(i, j, k).dot(u(i)) * u(j).dot(u(k)) / 2;
        force.segment<3>(3 * i) += tensors.C(j, k, i).dot(u(j)) * u(k) + tensors.C(i, j, k) * u(j).dot(u(k)) / 2;
        for (int l = 0; l < 4; ++l) {
          energy += tensors.D(i, j, k, l) * u(i).dot(u(j)) * u(k).dot(u(l)) / 2;
          force.segment<3>(3 * i) += 2 * tensors.D(j, k, l, i) * u(j).dot(u(k)) * u(l);
        }
      }
    }
  }
  EXPECT_NEAR(energy, energyOf(mesh, Kind::kStVenantKirchhoff, at), 1e-13 * energy);
  EXPECT_LT((force + forceOf(mesh, Kind::kStVenantKirchhoff, at)).norm(), 1e-13 * force.norm());
}

/// Equation (7) with normals of twice the faces' areas.
TEST(TetrahedronTensors, KIsThePapersWithItsMisprintsMended) {
  TetMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0.1, 0}, {0.2, 1.5, -0.1}, {0.1, 0.3, 1.2}};
  mesh.tetrahedra = {{0, 1, 2, 3}};
  const TetrahedronTensors tensors(mesh, 0, kLame);
  Eigen::Vector3d m[4];
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d &a = mesh.vertices[(i + 1) % 4], &b = mesh.vertices[(i + 2) % 4],
                          &c = mesh.vertices[(i + 3) % 4];
    m[i] = (b - a).cross(c - a);
    if (m[i].dot(mesh.vertices[i] - a) > 0) m[i] = -m[i];  // outwards
  }
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Eigen::Matrix3d expected = (kLame.lambda * m[i] * m[j].transpose() + kLame.mu * m[j] * m[i].transpose() +
                                        kLame.mu * m[i].dot(m[j]) * Eigen::Matrix3d::Identity()) /
                                       (36 * tensors.volume);
      EXPECT_LT((tensors.K(i, j) - expected).norm(), 1e-13 * expected.norm());
    }
  }
}

TEST(TensorMassForce, TellsHowMuchItKeepsAndRefusesBadMeshes) {
  TetMesh mesh = irregularMesh();
  EXPECT_EQ(TensorMassForce(mesh, kLame, Kind::kLinear).tensorBytes(), mesh.tetrahedra.size() * 54 * 8);
  EXPECT_EQ(TensorMassForce(mesh, kLame, Kind::kStVenantKirchhoff).tensorBytes(), mesh.tetrahedra.size() * 144 * 8);
  std::swap(mesh.tetrahedra[7][0], mesh.tetrahedra[7][1]);
  EXPECT_THROW(TensorMassForce(mesh, kLame, Kind::kLinear), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
