#include "cell/tensegrity/strut_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "cell/mechanics/equilibrium_system.h"
#include "cell/mechanics/layered_body.h"
#include "cell/mesh/mesh_checks.h"
#include "cell/tensegrity/spin_stop.h"

namespace microinjection {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kYoung = 1.2e9, kPoisson = 0.3, kStrutLength = 50e-6;

/// Linear response of a strut hinged at both ends.
struct Beam {
  Beam(double radius, ElementKind kind, int slices = 32)
      : section(kPi * radius * radius),
        strut({kStrutLength, section, slices, 0}, Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX(),
              Eigen::Vector3d::UnitY()) {
    MaterialConfig material;
    material.model = "linear";
    material.young_modulus = kYoung;
    material.poisson_ratio = kPoisson;
    const TetMesh& mesh = strut.mesh;
    const auto middle = [&](int a, int b) -> Eigen::Vector3d { return 0.5 * (mesh.vertices[a] + mesh.vertices[b]); };
    body = std::make_shared<LayeredBody<3>>(makeQuadratic(mesh, middle), kind,
                                            LayeredBody<3>::Materials{std::shared_ptr(makeMaterial(material))});
    const Eigen::VectorXd start = Eigen::VectorXd::Zero(body->stateSize());
    const std::array<int, 2> across = {strut.vertex(slices / 2, 0), strut.vertex(slices / 2, 2)};
    const double d = StrutMesh::circumradius(section);
    spin = std::make_shared<SpinStop>(std::vector<std::array<int, 2>>{across},
                                      1e-6 * kYoung * StrutMesh::secondMoment(section) / (kStrutLength * d * d), start);
  }

  Constraints constraints() const {
    Constraints result;
    result.entries.assign(body->stateSize(), Constraints::kFree);
    for (int k = 0; k < 3; ++k) result.entries[body->tipEntry() + k] = Constraints::tip(k);
    return result;
  }

  /// N/m, of the last apex pulled along the axis.
  double axial() const {
    Constraints held = constraints();
    for (int k = 0; k < 3; ++k) {
      held.entries[3 * strut.firstApex() + k] = Constraints::kFixed;
      held.entries[3 * strut.lastApex() + k] = k == 0 ? Constraints::tip(0) : Constraints::kFixed;
    }
    EquilibriumSystem system({body, spin}, held, SymmetricSolver::Method::kSimplicial);
    EXPECT_TRUE(system.factorise(Eigen::VectorXd::Zero(body->stateSize())));
    return system.stiffness()(0, 0);
  }

  /// N/m, of a force across the middle of the strut, hinged at both ends: 48 E I / L^3 of the beam.
  double bending() const {
    Constraints held = constraints();
    for (int k = 0; k < 3; ++k) {
      for (const int apex : {strut.firstApex(), strut.lastApex()}) held.entries[3 * apex + k] = Constraints::kFixed;
      for (int corner = 0; corner < StrutMesh::kCorners; ++corner) {
        if (k == 2) held.entries[3 * strut.vertex(slices() / 2, corner) + k] = Constraints::tip(k);
      }
    }
    held.entries[3 * strut.lastApex()] = Constraints::kFree;
    EquilibriumSystem system({body, spin}, held, SymmetricSolver::Method::kSimplicial);
    EXPECT_TRUE(system.factorise(Eigen::VectorXd::Zero(body->stateSize())));
    return system.stiffness()(2, 2);
  }
  int slices() const { return (static_cast<int>(strut.mesh.vertices.size()) - 2) / StrutMesh::kCorners - 1; }
  double expectedBending() const { return 48 * kYoung * StrutMesh::secondMoment(section) / std::pow(kStrutLength, 3); }

  double section;
  StrutMesh strut;
  std::shared_ptr<LayeredBody<3>> body;
  std::shared_ptr<SpinStop> spin;
};

TEST(StrutMesh, HasTheSizeOfThePaper) {
  const Beam beam(0.8e-6, ElementKind::kP1);
  EXPECT_NEAR(6 * beam.strut.mesh.vertices.size() / 1014.0, 1, 0.05);
  EXPECT_NEAR(6 * beam.strut.mesh.tetrahedra.size() / 1798.0, 1, 0.05);
  for (std::size_t t = 0; t < beam.strut.mesh.tetrahedra.size(); ++t) {
    EXPECT_GT(tetrahedronVolume(beam.strut.mesh, static_cast<int>(t)), 0);
  }
  const double radius = StrutMesh::circumradius(beam.section);
  EXPECT_NEAR(meshVolume(beam.strut.mesh) / (beam.section * (kStrutLength - radius + radius / 3)), 1, 1e-9);
  EXPECT_NEAR(StrutMesh::secondMoment(beam.section) / (beam.section * beam.section / (4 * kPi)), 1.017, 1e-3);
}

/// A prism is E S / L; a cap of height c, through which the load spreads from a point, gives more than c / (E S) but no
/// more than three times that (uniform strain in it) and some for the point.
TEST(StrutMesh, AxialStiffnessIsThatOfTheBar) {
  for (const double radius : {0.1e-6, 0.8e-6}) {
    const Beam beam(radius, ElementKind::kP1);
    const double bar = kYoung * beam.section / kStrutLength;
    const double caps = StrutMesh::circumradius(beam.section) / kStrutLength;  // of both, of the length
    EXPECT_LT(beam.axial() / bar, 1.001);
    EXPECT_GT(beam.axial() / bar, 1 / (1 + 5 * caps));
  }
}

/// Second-order tetrahedra bend as Euler-Bernoulli's beam, with a tenth of the length of the slice in thickness, too.
TEST(StrutMesh, SecondOrderTetrahedraBendAsABeam) {
  for (const double radius : {0.15e-6, 0.8e-6}) {
    const Beam beam(radius, ElementKind::kP2);
    EXPECT_NEAR(beam.bending() / beam.expectedBending(), 1, 0.03) << radius;
  }
}

/// The paper's P1 tetrahedra lock: their bending stiffness has a floor that does not fall with the section's second
/// moment, E S times the square of a slice's length. Of a single microtubule (13 nm) it is thousands of times too high.
TEST(StrutMesh, FirstOrderTetrahedraLockWithTheSquareOfTheirSlenderness) {
  double last = 0, last_radius = 0;
  for (const double radius : {12.9e-9, 0.1e-6, 0.8e-6}) {
    const Beam beam(radius, ElementKind::kP1);
    const double excess = beam.bending() / beam.expectedBending() - 1;
    EXPECT_GT(excess, radius < 0.2e-6 ? 20 : 0.5) << radius;
    if (radius < 0.2e-6 && last > 0) EXPECT_NEAR(excess / last * std::pow(radius / last_radius, 2), 1, 0.15);
    last = excess;
    last_radius = radius;
  }
  const Beam coarse(0.1e-6, ElementKind::kP1, 16), fine(0.1e-6, ElementKind::kP1, 32);
  const double ratio = coarse.bending() / fine.bending();
  EXPECT_NEAR(ratio, 4, 0.8);
}

}  // namespace
}  // namespace microinjection
