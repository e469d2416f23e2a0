#include "cell/mechanics/layered_body.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "base/finite_difference.h"
#include "cell/mechanics/bodies.h"

namespace microinjection {
namespace {

template <typename Case>
class LayeredBodyTest : public testing::Test {
 protected:
  using Body = LayeredBody<Case::kDim>;
  using Point = typename QuadraticMesh<Case::kDim>::Point;

  static std::shared_ptr<Body> block(const std::string& model, double poisson_ratio,
                                     Inversion inversion = Inversion::kRefused) {
    return makeBody(irregularBlock<Case::kDim>(3), Case::kKind, model, poisson_ratio, inversion);
  }

  /// Displacements up to `amplitude`, and pressures up to the shear modulus.
  static Eigen::VectorXd randomState(const Body& body, double amplitude) {
    Eigen::VectorXd state = randomVector(body.stateSize(), amplitude);
    const int displacements = Case::kDim * body.nodeCount();
    state.segment(displacements, body.pressureCount()) *= 1 / (amplitude * body.pressureUnit());
    return state;
  }

  static void expectDerivatives(const Body& body, Eigen::VectorXd state) {
    LocalEnergy at, local;
    for (int e = 0; e < body.elementCount(); e += 5) {
      const std::vector<int>& entries = body.entries(e);
      const int size = static_cast<int>(entries.size());
      Eigen::VectorXd own(size);
      for (int i = 0; i < size; ++i) own[i] = state[entries[i]];
      const auto evaluated = [&](const Eigen::VectorXd& values, Order order) -> const LocalEnergy& {
        for (int i = 0; i < size; ++i) state[entries[i]] = values[i];
        EXPECT_TRUE(body.evaluate(e, state, order, local));
        return local;
      };
      at = evaluated(own, Order::kHessian);
      ASSERT_EQ(at.gradient.size(), size);
      ASSERT_EQ(at.hessian.rows(), size);
      EXPECT_FALSE(at.zero);
      EXPECT_LT((at.hessian - at.hessian.transpose()).norm(), 1e-12 * at.hessian.norm());
      EXPECT_EQ(evaluated(own, Order::kEnergy).energy, at.energy);
      EXPECT_EQ(evaluated(own, Order::kGradient).gradient, at.gradient);
      const auto energy = [&](const Eigen::VectorXd& values) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, evaluated(values, Order::kEnergy).energy));
      };
      const auto gradient = [&](const Eigen::VectorXd& values) { return evaluated(values, Order::kGradient).gradient; };
      EXPECT_LT(derivativeError(energy, own, at.gradient.transpose(), 1e-6), 1e-6);
      EXPECT_LT(derivativeError(gradient, own, at.hessian, 1e-6), 1e-6);
      evaluated(own, Order::kEnergy);  // and back to where it was
    }
  }
};

TYPED_TEST_SUITE(LayeredBodyTest, AllElements, ElementCaseName);

TYPED_TEST(LayeredBodyTest, DerivativesAreThoseOfTheEnergy) {
  for (const std::string& model : materialModels()) {
    SCOPED_TRACE(model);
    const auto body = this->block(model, 0.45);
    this->expectDerivatives(*body, this->randomState(*body, 0.02));
  }
}

TYPED_TEST(LayeredBodyTest, DerivativesOfInvertedElementsToo) {
  const auto body = this->block("stable_neo_hookean", 0.45, Inversion::kAllowed);
  const Eigen::VectorXd state = this->randomState(*body, 0.6);
  ASSERT_LT(body->smallestJacobian(state), -1);
  this->expectDerivatives(*body, state);
}

TYPED_TEST(LayeredBodyTest, InternalForcesBalance) {
  constexpr int kDim = TypeParam::kDim;
  const auto body = this->block("neo_hookean", 0.45);
  const Eigen::VectorXd force = gradientOf(*body, this->randomState(*body, 0.02));
  Eigen::Matrix<double, kDim, 1> sum = Eigen::Matrix<double, kDim, 1>::Zero();
  for (int n = 0; n < plainNodes(*body); ++n) sum += force.template segment<kDim>(kDim * n);
  if (kDim == 2) sum[0] = 0;  // the hoop's stress holds the radial forces
  EXPECT_LT(sum.norm(), 1e-12 * force.norm());
}

TYPED_TEST(LayeredBodyTest, VolumeAndLayoutAreRight) {
  constexpr int kDim = TypeParam::kDim;
  const auto body = this->block("linear", 0.3);
  EXPECT_NEAR(body->volume(), kDim == 2 ? M_PI : 1, 1e-12);
  EXPECT_EQ(body->smallestJacobian(Eigen::VectorXd::Zero(body->stateSize())), 1);
  EXPECT_TRUE(body->isLinear());
  std::set<int> used;
  for (int e = 0; e < body->elementCount(); ++e) {
    const std::vector<int>& entries = body->entries(e);
    EXPECT_EQ(std::set<int>(entries.begin(), entries.end()).size(), entries.size());
    used.insert(entries.begin(), entries.end());
  }
  EXPECT_EQ(static_cast<int>(used.size()), body->tipEntry());  // all but the tip's
  EXPECT_EQ(*used.begin(), 0);
  EXPECT_EQ(*used.rbegin(), body->tipEntry() - 1);
}

/// Displacement (F - 1) X; in a section u_r = c r, u_z = d z.
template <int Dim>
Eigen::Matrix3d affine() {
  Eigen::Matrix3d F;
  F << 1.05, 0.025, -0.015, 0.01, 0.97, 0.02, -0.03, 0.005, 1.04;
  if (Dim == 2) F = Eigen::Vector3d(1.04, 1.04, 0.97).asDiagonal();
  return F;
}

Eigen::Vector3d displaced(const Eigen::Matrix3d& F, const Eigen::Vector3d& x) { return F * x - x; }
Eigen::Vector2d displaced(const Eigen::Matrix3d& F, const Eigen::Vector2d& x) {
  return {(F(0, 0) - 1) * x[0], (F(2, 2) - 1) * x[1]};
}

/// Patch test: with an affine displacement of the boundary the inside must follow exactly, whatever the mesh.
TYPED_TEST(LayeredBodyTest, AffineBoundaryGivesUniformDeformation) {
  constexpr int kDim = TypeParam::kDim;
  using Place = typename TestFixture::Point;
  const Eigen::Matrix3d F = affine<kDim>();
  const auto onBoundary = [](const Place& x) {
    return x[kDim - 1] == 0 || x.maxCoeff() == 1 || (kDim == 3 && x.minCoeff() == 0);
  };
  for (const char* model : {"linear", "neo_hookean"}) {
    SCOPED_TRACE(model);
    const auto body = this->block(model, 0.45);
    Constraints constraints = freeBody(*body);
    hold(*body, onBoundary, constraints);
    EquilibriumSystem system({body}, constraints, methodFor(body->kind()));
    const auto everywhere = [&](const Place& x) { return Place(displaced(F, x)); };
    const auto at_boundary = [&](const Place& x) { return onBoundary(x) ? everywhere(x) : Place(Place::Zero()); };
    const Eigen::VectorXd exact = stateOf(*body, everywhere);
    Eigen::VectorXd state = stateOf(*body, at_boundary), residual;
    Eigen::Vector3d unused;
    for (int iteration = 0; iteration < 10; ++iteration) {
      ASSERT_TRUE(system.residual(state, residual, unused));
      ASSERT_TRUE(system.factorise(state));
      system.addTo(state, -system.solve(residual), Eigen::Vector3d::Zero());
    }
    const int displacements = kDim * body->nodeCount();
    EXPECT_LT((state - exact).head(displacements).norm(), 1e-9 * exact.norm());
    const auto material_of_layer = material(model, 0.45);
    const double pressure = material_of_layer->dilatationalModulus() * material_of_layer->dilatation(F);
    for (int i = displacements; i < body->tipEntry(); ++i) {
      EXPECT_NEAR(body->pressureUnit() * state[i], pressure, 1e-9 * std::abs(pressure));
    }
    const double density = material_of_layer->energyDensity(F);
    double energy = 0;
    ASSERT_TRUE(system.energy(state, energy));
    EXPECT_NEAR(energy, density * body->volume(), 1e-9 * density);
    for (int e = 0; e < body->elementCount(); ++e) {
      for (int q = 0; q < body->pointCount(); ++q) {
        EXPECT_LT((body->deformationGradient(e, q, state) - F).norm(), 1e-9);
      }
    }
  }
}

TYPED_TEST(LayeredBodyTest, RigidRotationGivesNoForce) {
  constexpr int kDim = TypeParam::kDim;
  if constexpr (kDim == 3) {
    const Eigen::Matrix3d R = Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
    for (const std::string& model : materialModels()) {
      if (model == "linear") continue;
      const auto body = this->block(model, 0.45);
      const auto turned = [&](const Eigen::Vector3d& x) {
        return Eigen::Vector3d(R * x - x + Eigen::Vector3d::Ones());
      };
      const Eigen::VectorXd state = stateOf(*body, turned);
      const double stiffness = hessianOf(*body, Eigen::VectorXd::Zero(state.size())).diagonal().cwiseAbs().maxCoeff();
      EXPECT_LT(gradientOf(*body, state).norm(), 1e-10 * stiffness) << model;  // the block is of size 1
    }
  }
}

TYPED_TEST(LayeredBodyTest, InvertedElementsAreAdmissibleWhereAllowedOnly) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const std::string& model : materialModels()) {
    for (const Inversion inversion : {Inversion::kRefused, Inversion::kAllowed}) {
      const auto body = this->block(model, 0.45, inversion);
      const auto mirrored = [](const typename TestFixture::Point& x) {
        typename TestFixture::Point u = x;
        u.setZero();
        u[u.size() - 1] = -1.5 * x[x.size() - 1];
        return u;
      };
      const Eigen::VectorXd state = stateOf(*body, mirrored);
      EXPECT_LT(body->smallestJacobian(state), -0.4);
      const bool resists = model == "neo_hookean" || model == "mooney_rivlin" || model == "ogden" || model == "gent";
      const bool expected = model == "linear" || (inversion == Inversion::kAllowed && !resists);
      LocalEnergy local;
      local.energy = infinity;
      EXPECT_EQ(body->evaluate(0, state, Order::kHessian, local), expected) << model;
      EXPECT_TRUE(!expected || (std::isfinite(local.energy) && local.hessian.allFinite())) << model;
    }
  }
}

/// As one that inverts is: the energy is infinite, though det F > 0.
TYPED_TEST(LayeredBodyTest, AStretchBeyondTheMaterialsLimitIsNotAdmissible) {
  using Place = typename TestFixture::Point;
  const double limit = MaterialConfig().gent_limit;
  for (const Inversion inversion : {Inversion::kRefused, Inversion::kAllowed}) {
    const auto body = this->block("gent", 0.45, inversion);
    for (const double share : {0.999, 1.001}) {  // of the limit
      const double stretch = std::sqrt(1 + share * limit / 3);
      const Eigen::VectorXd state = stateOf(*body, [&](const Place& x) { return Place((stretch - 1) * x); });
      ASSERT_GT(body->smallestJacobian(state), 1);
      for (const Order order : {Order::kEnergy, Order::kGradient, Order::kHessian}) {
        LocalEnergy local;
        EXPECT_EQ(body->evaluate(0, state, order, local), share < 1) << stretch;
      }
    }
  }
}

TEST(LayeredBody, EachElementIsOfItsLayersMaterial) {
  const std::vector<double> radii = {1, 0.5};
  const QuadraticMesh<3> mesh = makeQuadratic(layeredBall(1, radii), radii);
  const auto soft = material("linear", 0.3, 1), stiff = material("linear", 0.3, 7);
  const LayeredBody<3> layered(mesh, ElementKind::kP1, {stiff, soft}),
      homogeneous(mesh, ElementKind::kP1, {soft, soft});
  const Eigen::VectorXd state = randomVector(layered.stateSize(), 0.1);
  LocalEnergy one, other;
  for (int e = 0; e < layered.elementCount(); ++e) {
    ASSERT_TRUE(layered.evaluate(e, state, Order::kGradient, one));
    ASSERT_TRUE(homogeneous.evaluate(e, state, Order::kGradient, other));
    EXPECT_NEAR(one.energy, (mesh.layers[e] == 0 ? 7 : 1) * other.energy, 1e-13 * one.energy);
  }
  EXPECT_THROW(LayeredBody<3>(mesh, ElementKind::kP1, {stiff}), std::invalid_argument);
}

TEST(LayeredBody, RefusesInvertedMeshes) {
  TetMesh mesh = unitCube(1);
  std::swap(mesh.tetrahedra[2][0], mesh.tetrahedra[2][1]);
  const QuadraticMesh<3> inverted = straight(makeQuadratic(mesh, {1.0}));
  EXPECT_THROW(makeBody(inverted, ElementKind::kP1, "linear", 0.3), std::invalid_argument);
  EXPECT_THROW(makeBody(inverted, ElementKind::kP2P0, "linear", 0.3), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
