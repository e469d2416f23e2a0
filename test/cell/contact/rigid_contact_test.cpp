#include "cell/contact/rigid_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "base/finite_difference.h"
#include "cell/contact/rounded_tip.h"
#include "cell/mesh/section_mesher.h"
#include "cell/mesh/swept_mesh.h"

namespace microinjection {
namespace {

constexpr double kRadius = 28e-6, kTip = 3e-6;  // m

QuadraticMesh<2> section() {
  SectionMeshConfig config;
  config.radii = {kRadius};
  config.size = 6e-6;
  config.refinements = {{0, +1, kTip, 1e-6}};
  return makeQuadratic(makeSectionMesh(config), config.radii);
}

template <int Dim>
struct Fixture {
  explicit Fixture(const RigidContactConfig& wanted) : body(mesh(), ElementKind::kP2, {makeMaterial({})}) {
    RigidContactConfig config = wanted;
    config.origin = {0, 0, kRadius};
    config.penalty = 1e12;
    contact = std::make_unique<RigidContact<Dim>>(body, std::make_shared<RoundedTip>(kTip, kTip), config);
  }

  static QuadraticMesh<Dim> mesh() {
    if constexpr (Dim == 2) {
      return section();
    } else {
      return sweepSection(section(), {});
    }
  }

  /// The tip some way in, the body a little and irregularly deformed.
  Eigen::VectorXd pushed(double depth, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> noise(-2e-9, 2e-9);
    Eigen::VectorXd state = Eigen::VectorXd::NullaryExpr(body.stateSize(), [&] { return noise(random); });
    state.tail<3>() = Eigen::Vector3d(0, 0, -depth);
    return state;
  }

  /// Whether the contact has changed.
  bool endStep(const Eigen::VectorXd& state) {
    const bool changed = contact->settle(state);
    contact->accept(state);
    return changed;
  }

  /// Derivatives of each facet's energy by finite differences; the number of facets that touch. Much deeper than at the
  /// last step the Hessian is not the true one, on purpose.
  int expectDerivatives(const Eigen::VectorXd& state, bool second = true) const {
    int touching = 0;
    for (int facet = 0; facet < contact->elementCount(); ++facet) {
      LocalEnergy at;
      EXPECT_TRUE(contact->evaluate(facet, state, Order::kHessian, at));
      if (at.zero) continue;
      ++touching;
      const std::vector<int>& entries = contact->entries(facet);
      Eigen::VectorXd local(entries.size());
      for (std::size_t i = 0; i < entries.size(); ++i) local[i] = state[entries[i]] / kTip;
      const auto evaluate = [&](const Eigen::VectorXd& x) {
        Eigen::VectorXd moved = state;
        for (std::size_t i = 0; i < entries.size(); ++i) moved[entries[i]] = kTip * x[i];
        LocalEnergy result;
        contact->evaluate(facet, moved, Order::kGradient, result);
        return result;
      };
      const auto energy = [&](const Eigen::VectorXd& x) {
        return Eigen::VectorXd(Eigen::VectorXd::Constant(1, evaluate(x).energy));
      };
      const auto gradient = [&](const Eigen::VectorXd& x) { return Eigen::VectorXd(evaluate(x).gradient); };
      EXPECT_LT(derivativeError(energy, local, kTip * at.gradient.transpose(), 1e-6), 1e-5);
      if (second) EXPECT_LT(derivativeError(gradient, local, kTip * at.hessian, 1e-6), 1e-4);
    }
    return touching;
  }

  LayeredBody<Dim> body;
  std::unique_ptr<RigidContact<Dim>> contact;
};

template <int Dim>
void expectDerivativesOf(const RigidContactConfig& config) {
  Fixture<Dim> fixture(config);
  EXPECT_EQ(fixture.expectDerivatives(fixture.pushed(-1e-6, 1)), 0);  // away from the cell
  const Eigen::VectorXd touching = fixture.pushed(0.02e-6, 2);
  EXPECT_GT(fixture.expectDerivatives(touching, false), 0);
  EXPECT_TRUE(fixture.endStep(touching) || config.mode == RigidContactConfig::Mode::kSliding);
  fixture.endStep(touching);
  EXPECT_GT(fixture.expectDerivatives(fixture.pushed(0.022e-6, 3)), 0);  // with a memory
}

TEST(RigidContact, DerivativesInTheSection) {
  expectDerivativesOf<2>({});
  RigidContactConfig sliding;
  sliding.mode = RigidContactConfig::Mode::kSliding;
  expectDerivativesOf<2>(sliding);
  sliding.hardening = 0.01e-6;
  expectDerivativesOf<2>(sliding);
  sliding.hardening = 0.0005e-6;  // the penalty grows no more at this depth
  expectDerivativesOf<2>(sliding);
  sliding.hardening = 0;
  sliding.friction = 0.3;
  expectDerivativesOf<2>(sliding);
  sliding.slip_range = 0.03e-6;
  expectDerivativesOf<2>(sliding);
}

TEST(RigidContact, DerivativesInSpace) { expectDerivativesOf<3>({}); }

RigidContactConfig adhesive(RigidContactConfig::Mode mode) {
  RigidContactConfig config;
  config.mode = mode;
  config.adhesion = 2e-3;
  config.adhesion_range = 0.5e-6;
  return config;
}

template <int Dim>
void expectAdhesion(RigidContactConfig::Mode mode) {
  Fixture<Dim> fixture(adhesive(mode));
  const Eigen::VectorXd above = fixture.pushed(-0.3e-6, 6);
  EXPECT_EQ(fixture.expectDerivatives(above), 0);  // not before it has touched
  fixture.endStep(fixture.pushed(0.3e-6, 7));
  const Eigen::VectorXd gap = fixture.pushed(-0.2e-6, 8);
  fixture.endStep(gap);  // what sticks parts
  EXPECT_GT(fixture.expectDerivatives(gap), 0);
  fixture.endStep(fixture.pushed(-15e-6, 9));
  EXPECT_EQ(fixture.expectDerivatives(above), 0);  // it was torn off
}

TEST(RigidContact, DerivativesOfAdhesion) {
  expectAdhesion<2>(RigidContactConfig::Mode::kSliding);
  expectAdhesion<2>(RigidContactConfig::Mode::kSticking);
  expectAdhesion<3>(RigidContactConfig::Mode::kSliding);
}

/// Of a tip that is drawn off a rigid surface: energy of parting times the area that has touched, and its most.
TEST(RigidContact, AdhesionDoesTheWorkThatItIsGiven) {
  Fixture<2> fixture(adhesive(RigidContactConfig::Mode::kSliding));
  const auto rigid = [&](double depth) {
    Eigen::VectorXd state = Eigen::VectorXd::Zero(fixture.body.stateSize());
    state[state.size() - 1] = -depth;
    return state;
  };
  constexpr double kDepth = 0.1e-6;
  fixture.endStep(rigid(kDepth));
  const auto pull = [&](double depth) {  // N, downwards on the tip
    double sum = 0;
    for (int facet = 0; facet < fixture.contact->elementCount(); ++facet) {
      LocalEnergy local;
      fixture.contact->evaluate(facet, rigid(depth), Order::kGradient, local);
      if (!local.zero) sum += local.gradient[local.gradient.size() - 1];
    }
    return sum;
  };
  double touched = 0;  // m^2, of the points that touch: what they resist with, over the penalty
  for (int facet = 0; facet < fixture.contact->elementCount(); ++facet) {
    LocalEnergy local;
    fixture.contact->evaluate(facet, rigid(kDepth), Order::kHessian, local);
    if (!local.zero) touched += local.hessian(local.hessian.rows() - 1, local.hessian.cols() - 1) / 1e12;
  }
  const double reduced = 1 / (1 / kTip + 1 / kRadius), area = 2 * 3.14159265358979 * reduced * kDepth;
  EXPECT_NEAR(touched, area, 0.25 * area);  // quadrature sees the circle coarsely
  double work = 0;
  constexpr double kStep = 2e-9;
  for (double depth = -kStep / 2; depth > -6e-6; depth -= kStep) work += pull(depth) * kStep;
  // From the touch on; the rim of what touched is a little apart then.
  EXPECT_NEAR(work, 2e-3 * touched, 0.05 * 2e-3 * touched);
  const double most = 2e-3 / (std::exp(1.0) * 0.5e-6) * touched;
  EXPECT_NEAR(pull(-0.5e-6), most, 0.07 * most);
}

/// A tip that is pressed onto a rigid surface and turned along it resists like a spring until it has slipped by the
/// range, and with Coulomb's share of the normal force from then on; back, it springs back first.
TEST(RigidContact, FrictionIsElasticWithinItsRange) {
  constexpr double kShare = 0.3, kRange = 0.05e-6;
  RigidContactConfig config;
  config.mode = RigidContactConfig::Mode::kSliding;
  config.friction = kShare;
  config.slip_range = kRange;
  Fixture<3> fixture(config);
  const auto at = [&](double aside) {  // the whole surface moves aside under the tip
    Eigen::VectorXd state = Eigen::VectorXd::Zero(fixture.body.stateSize());
    state[fixture.body.tipEntry()] = aside;
    state[fixture.body.tipEntry() + 2] = -0.05e-6;
    return state;
  };
  const auto forceOn = [&](const Eigen::VectorXd& state) {  // N, (x, z) on the tip
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int facet = 0; facet < fixture.contact->elementCount(); ++facet) {
      LocalEnergy local;
      fixture.contact->evaluate(facet, state, Order::kGradient, local);
      if (!local.zero) sum -= Eigen::Vector2d(local.gradient[local.gradient.size() - 3], local.gradient.tail<1>()[0]);
    }
    return sum;
  };
  fixture.endStep(at(0));
  fixture.endStep(at(0));
  const double normal = forceOn(at(0)).y();
  ASSERT_GT(normal, 0);
  const double bound = kShare * normal, about = 0.1 * bound;  // the points that touch see the tip's round end
  EXPECT_NEAR(forceOn(at(0.5 * kRange)).x(), -0.5 * bound, about);
  EXPECT_NEAR(forceOn(at(kRange)).x(), -bound, about);
  EXPECT_NEAR(forceOn(at(2 * kRange)).x(), -bound, about);
  fixture.endStep(at(2 * kRange));
  EXPECT_NEAR(forceOn(at(2 * kRange)).x(), -kShare * forceOn(at(2 * kRange)).y(), about);
  EXPECT_NEAR(forceOn(at(kRange)).x(), 0, about);
}

TEST(RigidContact, TheNeedleCanLoseIt) {
  Fixture<2> fixture({});
  fixture.endStep(fixture.pushed(0.3e-6, 4));
  EXPECT_GT(fixture.contact->touchingPoints(), 0);
  const Eigen::VectorXd away = fixture.pushed(-2e-6, 5);
  EXPECT_TRUE(fixture.endStep(away));
  EXPECT_EQ(fixture.contact->touchingPoints(), 0);
  EXPECT_EQ(fixture.expectDerivatives(away), 0);
}

}  // namespace
}  // namespace microinjection
