// Bodies that are hard on the elements and on the equations: thin elements, incompressibility, contrast of stiffness.

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "cell/mechanics/bodies.h"
#include "cell/mechanics/load_path.h"

namespace microinjection {
namespace {

LoadPathConfig pathConfig(double length) {
  LoadPathConfig config;
  config.length = length;
  config.first_step = config.largest_step = length / 16;
  config.smallest_step = 1e-5 * length;
  return config;
}

struct Pressed {
  double force = 0;
  double volume = 0;      ///< deformed over undeformed
  double worst_step = 0;  ///< of the equilibrium at the end: what one more step of Newton's method would move
};

template <int Dim>
Pressed press(const std::shared_ptr<LayeredBody<Dim>>& body, const Constraints& constraints, double depth) {
  EquilibriumSystem system({body}, constraints, methodFor(body->kind()));
  LoadPath path(system, pathConfig(1));
  const LoadPath::Result result = path.advance({0, 0, -depth});
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_TRUE(path.state().allFinite() && path.reaction().allFinite() && path.stiffness().allFinite());
  EXPECT_GT(body->smallestJacobian(path.state()), 0);
  Pressed pressed;
  pressed.force = -path.reaction().z();
  Eigen::VectorXd residual;
  Eigen::Vector3d reaction;
  EXPECT_TRUE(system.residual(path.state(), residual, reaction) && system.factorise(path.state()));
  Eigen::VectorXd step = Eigen::VectorXd::Zero(body->stateSize());
  system.addTo(step, system.solve(residual), Eigen::Vector3d::Zero());
  pressed.worst_step = step.head(Dim * body->nodeCount()).cwiseAbs().maxCoeff();
  double sum = 0;
  for (int e = 0; e < body->elementCount(); ++e) {
    for (int q = 0; q < body->pointCount(); ++q) sum += body->deformationGradient(e, q, path.state()).determinant();
  }
  pressed.volume = sum / (body->elementCount() * body->pointCount());
  return pressed;
}

/// The unit cube in n^3 pieces, two layers of vertices in its middle so near to each other that the elements between
/// them are as many times wider than thick as `aspect` says.
QuadraticMesh<3> cubeWithThinElements(int n, double aspect) {
  TetMesh mesh = unitCube(n);
  const double middle = (n / 2) / double(n), thickness = 1 / (n * aspect);
  for (Eigen::Vector3d& x : mesh.vertices) {
    if (x.z() > middle && x.z() < middle + 1.5 / n) x.z() = middle + thickness;
  }
  return straight(makeQuadratic(mesh, {1.0}));
}

TEST(DifficultBodies, ThinElementsDoNoHarm) {
  for (const std::string& name : elementNames()) {
    SCOPED_TRACE(name);
    const ElementKind kind = elementKind(name);
    const auto pressed = [&](double aspect) {
      const auto body = makeBody(cubeWithThinElements(4, aspect), kind, "neo_hookean", 0.45);
      return press(body, betweenPlates(*body), 0.15);
    };
    const Pressed even = pressed(4), thin = pressed(100);
    EXPECT_LT(thin.worst_step, 1e-7);
    EXPECT_NEAR(thin.force / even.force, 1, isQuadratic(kind) ? 0.01 : 0.06);
  }
}

/// A ball with one flat tetrahedron of aspect ratio 100 (a sliver: its four corners near one plane) in it.
TEST(DifficultBodies, SliversDoNoHarm) {
  TetMesh mesh = unitCube(3);
  // The corners of one inner cube's tetrahedron, the last one moved almost into the plane of the others.
  const std::array<int, 4> corners = mesh.tetrahedra[6 * 13];
  const Eigen::Vector3d &a = mesh.vertices[corners[0]], &b = mesh.vertices[corners[1]], &c = mesh.vertices[corners[2]];
  const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
  Eigen::Vector3d& d = mesh.vertices[corners[3]];
  d -= (normal.dot(d - a) - 0.01 / 3) * normal;
  double worst = 1;
  for (int t = 0; t < static_cast<int>(mesh.tetrahedra.size()); ++t) worst = std::min(worst, radiusRatio(mesh, t));
  ASSERT_GT(worst, 0);
  ASSERT_LT(worst, 0.03);
  for (const std::string& name : elementNames()) {
    SCOPED_TRACE(name);
    const ElementKind kind = elementKind(name);
    const auto body = makeBody(straight(makeQuadratic(mesh, {1.0})), kind, "neo_hookean", 0.45);
    const auto regular = makeBody(straight(makeQuadratic(unitCube(3), {1.0})), kind, "neo_hookean", 0.45);
    const Pressed sliver = press(body, betweenPlates(*body), 0.1), even = press(regular, betweenPlates(*regular), 0.1);
    EXPECT_LT(sliver.worst_step, 1e-7);
    EXPECT_NEAR(sliver.force / even.force, 1, 0.05);
  }
}

/// Ball in section, `arcs` elements along its half circle (a multiple of eight: the caps end at 45 degrees), six rings.
QuadraticMesh<2> section(int arcs) {
  const std::vector<double> radii = {1, 0.85, 0.7, 0.55, 0.4, 0.2};
  return makeQuadratic(layeredHalfDisc(arcs, radii), radii);
}

/// The rings from `inner` on are of the second material.
std::shared_ptr<LayeredBody<2>> layered(int arcs, ElementKind kind,
                                        const std::shared_ptr<const Material>& outer_material,
                                        const std::shared_ptr<const Material>& inner_material, int inner = 2) {
  LayeredBody<2>::Materials materials;
  for (int ring = 0; ring < 6; ++ring) materials.push_back(ring < inner ? outer_material : inner_material);
  return std::make_shared<LayeredBody<2>>(section(arcs), kind, materials);
}

TEST(DifficultBodies, NearlyIncompressibleMixedElementsAgreeAndKeepTheVolume) {
  const auto incompressible = material("neo_hookean", 0.4999);
  const auto pressed = [&](int arcs, ElementKind kind) {
    const auto body = layered(arcs, kind, incompressible, incompressible);
    const Pressed result = press(body, betweenCaps(*body, 1), 0.2);
    EXPECT_LT(result.worst_step, 1e-7) << elementName(kind);
    return result;
  };
  const double reference = pressed(32, ElementKind::kP2P1).force;
  for (const ElementKind kind : {ElementKind::kMini, ElementKind::kP1P1, ElementKind::kP2P0, ElementKind::kP2P1}) {
    SCOPED_TRACE(elementName(kind));
    const Pressed result = pressed(16, kind);
    EXPECT_NEAR(result.force / reference, 1, isQuadratic(kind) ? 0.02 : 0.15);
    EXPECT_NEAR(result.volume, 1, 0.01);
  }
  EXPECT_GT(pressed(16, ElementKind::kP1).force, 1.5 * reference);  // locks, but has a solution
  EXPECT_GT(pressed(16, ElementKind::kP2).force, reference);
}

TEST(DifficultBodies, StiffnessContrastOfAThousand) {
  const auto soft = material("neo_hookean", 0.49, 1), stiff = material("neo_hookean", 0.49, 1000);
  for (const std::string& name : elementNames()) {
    const ElementKind kind = elementKind(name);
    const auto force = [&](int arcs, const auto& outer, const auto& inner) {
      const auto body = layered(arcs, kind, outer, inner);
      const Pressed result = press(body, betweenCaps(*body, 1), 0.1);
      EXPECT_LT(result.worst_step, 1e-7) << name;
      return result.force;
    };
    const double all_soft = force(16, soft, soft), all_stiff = force(16, stiff, stiff);
    for (const bool stiff_outside : {true, false}) {
      SCOPED_TRACE(name + (stiff_outside ? ", stiff outside" : ", stiff inside"));
      const auto &outer = stiff_outside ? stiff : soft, &inner = stiff_outside ? soft : stiff;
      const double coarse = force(16, outer, inner), fine = force(24, outer, inner);
      EXPECT_GT(coarse, all_soft);
      EXPECT_LT(coarse, all_stiff);
      EXPECT_NEAR(coarse / fine, 1, isQuadratic(kind) ? 0.05 : 0.4);
    }
  }
}

TEST(DifficultBodies, ContrastAndIncompressibilityInSpace) {
  const std::vector<double> radii = {1, 0.5};
  const QuadraticMesh<3> mesh = makeQuadratic(layeredBall(1, radii), radii);
  const auto soft = material("neo_hookean", 0.4999, 1), stiff = material("neo_hookean", 0.4999, 1000);
  for (const std::string& name : elementNames()) {
    SCOPED_TRACE(name);
    const auto pressed = [&](const auto& outer, const auto& inner) {
      const auto body =
          std::make_shared<LayeredBody<3>>(mesh, elementKind(name), LayeredBody<3>::Materials{outer, inner});
      return press(body, betweenCaps(*body, 1), 0.05);
    };
    const Pressed shell = pressed(stiff, soft), core = pressed(soft, stiff), all_soft = pressed(soft, soft);
    EXPECT_LT(std::max(shell.worst_step, core.worst_step), 1e-7);
    EXPECT_GT(core.force, all_soft.force);
    EXPECT_GT(shell.force, core.force);
    EXPECT_LT(shell.force, 1000 * all_soft.force);
  }
}

}  // namespace
}  // namespace microinjection
