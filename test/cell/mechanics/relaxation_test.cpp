#include "cell/mechanics/relaxation.h"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <tuple>

#include "cell/mechanics/bodies.h"

namespace microinjection {
namespace {

constexpr double kRadius = 28e-6;      // m
constexpr double kCellYoung = 17.9e3;  // Pa
const std::vector<double> kBallRadii = {kRadius, kRadius / 2};

bool onSurface(const Eigen::Vector3d& x) { return x.norm() > 0.999 * kRadius; }

struct Ball {
  Ball(ElementKind kind, const std::string& model, double poisson_ratio, Inversion inversion = Inversion::kAllowed) {
    const auto layer = material(model, poisson_ratio, kCellYoung);
    body = std::make_shared<LayeredBody<3>>(makeQuadratic(layeredBall(1, kBallRadii), kBallRadii), kind,
                                            LayeredBody<3>::Materials{layer, layer}, inversion);
  }

  EquilibriumSystem system(const Constraints& constraints) const {
    return EquilibriumSystem({body}, constraints, SymmetricSolver::Method::kSimplicial);
  }

  Constraints withSurfaceHeld() const {
    Constraints constraints = freeBody(*body);
    hold(*body, onSurface, constraints);
    return constraints;
  }

  /// Throws all free inner nodes to random places of the ball.
  void scramble(const Constraints& constraints, int seed, Eigen::VectorXd& state) const {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> coordinate(-kRadius, kRadius);
    for (int n = 0; n < plainNodes(*body); ++n) {
      const Eigen::Vector3d& x = body->mesh().nodes[n];
      if (constraints.entries[3 * n] != Constraints::kFree || onSurface(x)) continue;
      Eigen::Vector3d place;
      do {
        for (int k = 0; k < 3; ++k) place[k] = coordinate(generator);
      } while (place.norm() > kRadius);
      state.segment<3>(3 * n) = place - x;
    }
  }

  double energy(EquilibriumSystem& in, Eigen::VectorXd state) const {
    double energy = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(in.assemble(state) && in.settleInternal(state) && in.energy(state, energy));
    return energy;
  }

  std::shared_ptr<LayeredBody<3>> body;
};

RelaxationConfig config() {
  RelaxationConfig config;
  config.length = kRadius;
  return config;
}

class RelaxationTest : public testing::TestWithParam<std::tuple<std::string, double, ElementKind>> {
 protected:
  const Ball ball_{std::get<2>(GetParam()), std::get<0>(GetParam()), std::get<1>(GetParam())};
};

TEST_P(RelaxationTest, ScrambledInsideComesBack) {
  const Constraints constraints = ball_.withSurfaceHeld();
  EquilibriumSystem system = ball_.system(constraints);
  Relaxation relaxation(system, config());
  const bool quick = std::get<2>(GetParam()) == ElementKind::kP1;
  for (int seed = 1; seed <= (quick ? 4 : 1); ++seed) {
    Eigen::VectorXd state = Eigen::VectorXd::Zero(ball_.body->stateSize());
    ball_.scramble(constraints, seed, state);
    ASSERT_LT(ball_.body->smallestJacobian(state), -1);
    const double start = ball_.energy(system, state);
    const Relaxation::Result result = relaxation.relax(state);
    EXPECT_TRUE(result.converged) << seed << ": " << result.reason;
    EXPECT_TRUE(result.reason.empty());
    EXPECT_LT(std::abs(result.energy), 1e-9 * start);
    EXPECT_LT(state.cwiseAbs().maxCoeff(), 1e-6 * kRadius) << seed;
  }
}

/// From a tip that has been displaced: to the same state as without the scrambling.
TEST_P(RelaxationTest, ScrambledUnderADisplacedTipComesToTheEquilibriumThere) {
  const Constraints constraints = betweenCaps(*ball_.body, kRadius);
  EquilibriumSystem system = ball_.system(constraints);
  Relaxation relaxation(system, config());
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(ball_.body->stateSize());
  system.addTo(rest, Eigen::VectorXd::Zero(system.freeSize()), {1e-6, 0, -4e-6});
  Eigen::VectorXd state = rest, residual;
  const Eigen::VectorXd prescribed = rest;
  const Relaxation::Result tidy = relaxation.relax(rest);
  ASSERT_TRUE(tidy.converged) << tidy.reason;
  Eigen::Vector3d reaction;
  ASSERT_TRUE(system.residual(rest, residual, reaction));
  EXPECT_LT(reaction.z(), -0.1e-6);
  EXPECT_LT(residual.norm(), 1e-8 * reaction.norm());
  for (int i = 0; i < prescribed.size(); ++i) {
    EXPECT_TRUE(constraints.entries[i] >= 0 || rest[i] == prescribed[i]);
  }
  EXPECT_TRUE(system.factorise(rest));  // stable
  const bool several = GetParam() == std::make_tuple(std::string("corotated"), 0.499, ElementKind::kP1);
  if (several) return;  // it has states of rest with inverted elements, too
  ball_.scramble(constraints, 2, state);
  const Relaxation::Result result = relaxation.relax(state);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_NEAR(result.energy, tidy.energy, 1e-9 * tidy.energy);
  EXPECT_LT((state - rest).cwiseAbs().maxCoeff(), 1e-6 * kRadius);
}

std::string caseName(const testing::TestParamInfo<RelaxationTest::ParamType>& instance) {
  const auto& [model, poisson_ratio, kind] = instance.param;
  return model + "_" + std::to_string(std::lround(1000 * poisson_ratio)) + "_" + elementName(kind);
}

INSTANTIATE_TEST_SUITE_P(All, RelaxationTest,
                         testing::Combine(testing::Values("stable_neo_hookean", "corotated"),
                                          testing::Values(0.45, 0.499),
                                          testing::Values(ElementKind::kP1, ElementKind::kP2P0)),
                         caseName);

TEST(Relaxation, AtRestItStays) {
  const Ball ball(ElementKind::kP1, "neo_hookean", 0.49, Inversion::kRefused);
  EquilibriumSystem system = ball.system(ball.withSurfaceHeld());
  Relaxation relaxation(system, config());
  Eigen::VectorXd state = Eigen::VectorXd::Zero(ball.body->stateSize());
  const Relaxation::Result result = relaxation.relax(state);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_LT(state.norm(), 1e-15 * kRadius);
}

TEST(Relaxation, SaysThatItDidNotConvergeAndWhy) {
  const Ball refusing(ElementKind::kP1, "stable_neo_hookean", 0.45, Inversion::kRefused);
  const Constraints constraints = refusing.withSurfaceHeld();
  EquilibriumSystem strict = refusing.system(constraints);
  Eigen::VectorXd state = Eigen::VectorXd::Zero(refusing.body->stateSize());
  refusing.scramble(constraints, 1, state);
  const Eigen::VectorXd scrambled = state;
  const Relaxation::Result refused = Relaxation(strict, config()).relax(state);
  EXPECT_FALSE(refused.converged);
  EXPECT_NE(refused.reason.find("not defined"), std::string::npos) << refused.reason;
  EXPECT_EQ(state, scrambled);

  const Ball ball(ElementKind::kP1, "stable_neo_hookean", 0.45);
  EquilibriumSystem system = ball.system(constraints);
  RelaxationConfig few = config();
  few.maximum_iterations = 5;
  const Relaxation::Result stopped = Relaxation(system, few).relax(state);
  EXPECT_FALSE(stopped.converged);
  EXPECT_NE(stopped.reason.find("iterations"), std::string::npos) << stopped.reason;
  EXPECT_LE(stopped.iterations, 5 + 20);  // it ends the search for a shift that it began
  EXPECT_LT(stopped.energy, ball.energy(system, scrambled));
  EXPECT_NEAR(stopped.energy, ball.energy(system, state), 1e-12 * stopped.energy);
}

TEST(Relaxation, RefusesPressures) {
  const Ball ball(ElementKind::kP2P1, "stable_neo_hookean", 0.45);
  EquilibriumSystem system({ball.body}, ball.withSurfaceHeld(), SymmetricSolver::Method::kIndefinite);
  EXPECT_THROW(Relaxation(system, config()), std::invalid_argument);
}

/// Energy k/4 (x^2 - 1)^2 of one entry, flat in a second one.
class DoubleWell : public EnergyTerm {
 public:
  int elementCount() const override { return 1; }
  const std::vector<int>& entries(int) const override { return entries_; }
  bool evaluate(int, const Eigen::VectorXd& state, Order, LocalEnergy& result) const override {
    const double x = state[0], y = state[1];
    result.energy = 0.25 * (x * x - 1) * (x * x - 1) + 0.5 * stiffness * y * y;
    result.gradient = Eigen::Vector2d(x * (x * x - 1), stiffness * y);
    result.hessian = Eigen::Vector2d(3 * x * x - 1, stiffness).asDiagonal();
    return true;
  }
  double stiffness = 1;  ///< of the second entry

 private:
  std::vector<int> entries_ = {0, 1};
};

TEST(Relaxation, LeavesAStateOfRestThatIsNotStable) {
  const auto term = std::make_shared<DoubleWell>();
  Constraints constraints;
  constraints.entries = {Constraints::kFree, Constraints::kFree, Constraints::tip(0), Constraints::tip(1),
                         Constraints::tip(2)};
  EquilibriumSystem system({term}, constraints, SymmetricSolver::Method::kSimplicial);
  RelaxationConfig config;
  config.length = 1;
  Relaxation relaxation(system, config);
  Eigen::VectorXd state = Eigen::VectorXd::Zero(5);
  state[1] = 0.3;
  const Relaxation::Result result = relaxation.relax(state);
  EXPECT_TRUE(result.converged) << result.reason;
  EXPECT_NEAR(std::abs(state[0]), 1, 1e-9);
  EXPECT_NEAR(state[1], 0, 1e-9);
  EXPECT_NEAR(result.energy, 0, 1e-12);
  term->stiffness = 0;  // now one motion costs nothing
  const Relaxation::Result neutral = relaxation.relax(state);
  EXPECT_FALSE(neutral.converged);
  EXPECT_NE(neutral.reason.find("not stable"), std::string::npos) << neutral.reason;
}

}  // namespace
}  // namespace microinjection
