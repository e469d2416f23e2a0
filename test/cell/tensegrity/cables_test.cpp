#include "cell/tensegrity/cables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cell/mechanics/term_derivatives.h"

namespace microinjection {
namespace {

constexpr double kCableLength = 30e-6, kCableStiffness = 4e-8;  // m, N
constexpr double kEver = std::numeric_limits<double>::infinity();

/// One cable along x from the origin, whose other end moves.
struct OneCable {
  explicit OneCable(double retardation_time = 0)
      : cables(std::make_shared<NodePositions>(NodePositions{Eigen::Vector3d::Zero(), {kCableLength, 0, 0}}),
               {{0, 1, kCableLength, kCableStiffness, retardation_time}}, Eigen::VectorXd::Zero(9)) {}

  Eigen::VectorXd at(double stretch) const {
    Eigen::VectorXd state = Eigen::VectorXd::Zero(9);
    state[3] = stretch;
    return state;
  }
  /// Tension, N, at the end of a step to this stretch (m) in this time (s).
  double step(double stretch, double duration) {
    cables.beginStep(duration);
    const double tension = cables.tension(0, at(stretch));
    cables.accept(at(stretch));
    return tension;
  }
  Cables cables;
};

TEST(Cables, PullsInProportionToItsStrainAndNeverPushes) {
  OneCable one;
  EXPECT_NEAR(one.cables.tension(0, one.at(0.1 * kCableLength)), 0.1 * kCableStiffness, 1e-12 * kCableStiffness);
  EXPECT_EQ(one.cables.tension(0, one.at(-0.1 * kCableLength)), 0);
  LocalEnergy slack;
  EXPECT_TRUE(one.cables.evaluate(0, one.at(-0.1 * kCableLength), Order::kHessian, slack));
  EXPECT_TRUE(slack.zero);
}

TEST(Cables, DerivativesAreThoseOfTheEnergy) {
  for (const double duration : {kEver, 0.3}) {
    OneCable one(0.5);
    one.step(0.05 * kCableLength, 1);
    one.cables.beginStep(duration);
    Eigen::VectorXd state = one.at(0.2 * kCableLength);
    state[1] = 3e-6;
    state[5] = -4e-6;
    expectDerivatives(one.cables, state, 1e-5 * kCableLength, 1e-7);
    LocalEnergy result;
    one.cables.evaluate(0, state, Order::kGradient, result);
    EXPECT_NEAR(result.gradient.head<3>().norm(), one.cables.tension(0, state), 1e-12 * kCableStiffness);
  }
}

/// Stretched at a constant rate, Kelvin-Voigt's tension is E S (strain + retardation time x strain rate), exactly, in
/// steps of any size; and held, it is the elastic part alone at once.
TEST(Cables, KelvinVoigtAddsTheRate) {
  const double retardation = 0.5, rate = 0.2;  // s, 1/s
  for (const double step : {0.1, 0.01}) {
    OneCable one(retardation);
    double strain = 0, tension = 0;
    for (int i = 0; i < 5; ++i) tension = one.step((strain += rate * step) * kCableLength, step);
    EXPECT_NEAR(tension, kCableStiffness * (strain + retardation * rate), 1e-9 * kCableStiffness);
    EXPECT_NEAR(one.step(strain * kCableLength, step), kCableStiffness * strain, 1e-9 * kCableStiffness);
  }
}

/// Let go suddenly, a viscous cable hangs slack at the length that it had and creeps back, exp(-t / retardation time):
/// taken up again before that it does not pull where an elastic one would.
TEST(Cables, ASlackViscousCableCreepsBack) {
  const double retardation = 0.5, strain = 0.2, wait = 0.4;
  const int steps = 4000;
  OneCable one(retardation);
  one.step(strain * kCableLength, kEver);
  EXPECT_EQ(one.step(0, 1e-9), 0);  // end to end at its rest length, but longer itself
  for (int i = 0; i < steps; ++i) one.step(0, wait / steps);
  const double left = strain * std::exp(-wait / retardation);
  one.cables.beginStep(1e-9);
  EXPECT_EQ(one.cables.tension(0, one.at(0.99 * left * kCableLength)), 0);
  EXPECT_GT(one.cables.tension(0, one.at(1.01 * left * kCableLength)), 0);
}

TEST(Cables, ATryThatIsNotAcceptedIsForgotten) {
  OneCable one(0.5), other(0.5);
  one.cables.beginStep(0.1);
  one.cables.beginStep(0.2);
  other.cables.beginStep(0.2);
  EXPECT_EQ(one.cables.tension(0, one.at(1e-6)), other.cables.tension(0, other.at(1e-6)));
  one.cables.accept(one.at(1e-6));
  EXPECT_EQ(one.cables.tension(0, one.at(1e-6)), other.cables.tension(0, other.at(1e-6)));  // still at equilibrium
  one.cables.reset();
  EXPECT_NEAR(one.cables.tension(0, one.at(1e-6)), kCableStiffness * 1e-6 / kCableLength, 1e-12 * kCableStiffness);
}

TEST(Cables, RefusesWhatIsNoCable) {
  const auto places = std::make_shared<NodePositions>(NodePositions(2, Eigen::Vector3d::Zero()));
  const Eigen::VectorXd start = Eigen::VectorXd::Zero(9);
  EXPECT_THROW(Cables(places, {{0, 1, 0, kCableStiffness, 0}}, start), std::invalid_argument);
  EXPECT_THROW(Cables(places, {{0, 1, kCableLength, -1, 0}}, start), std::invalid_argument);
  EXPECT_THROW(Cables(places, {{0, 1, kCableLength, kCableStiffness, -1}}, start), std::invalid_argument);
}

}  // namespace
}  // namespace microinjection
