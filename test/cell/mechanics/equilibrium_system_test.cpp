#include "cell/mechanics/equilibrium_system.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "cell/mechanics/bodies.h"

namespace microinjection {
namespace {

/// Springs that hold one node in all three directions to the tip; its derivatives are by the tip's entries, too.
class TipSpring : public EnergyTerm {
 public:
  TipSpring(int node, int tip_entry, double stiffness) : stiffness_(stiffness) {
    for (int k = 0; k < 3; ++k) entries_.push_back(3 * node + k);
    for (int k = 0; k < 3; ++k) entries_.push_back(tip_entry + k);
  }
  int elementCount() const override { return 2; }  // the second one is slack
  const std::vector<int>& entries(int) const override { return entries_; }
  bool evaluate(int element, const Eigen::VectorXd& state, Order, LocalEnergy& result) const override {
    result.zero = element == 1;
    const Eigen::Vector3d stretch = state.segment<3>(entries_[0]) - state.segment<3>(entries_[3]);
    result.energy = 0.5 * stiffness_ * stretch.squaredNorm();
    result.gradient.resize(6);
    result.gradient << stiffness_ * stretch, -stiffness_ * stretch;
    result.hessian = stiffness_ * Eigen::MatrixXd::Identity(6, 6);
    result.hessian.topRightCorner<3, 3>().diagonal().setConstant(-stiffness_);
    result.hessian.bottomLeftCorner<3, 3>().diagonal().setConstant(-stiffness_);
    return true;
  }

 private:
  double stiffness_;
  std::vector<int> entries_;
};

template <typename Case>
class EquilibriumSystemTest : public testing::Test {
 protected:
  const std::shared_ptr<LayeredBody<Case::kDim>> body_ =
      makeBody(irregularBlock<Case::kDim>(2), Case::kKind, "neo_hookean", 0.4);
  const Constraints constraints_ = betweenPlates(*body_);
  EquilibriumSystem system_{{body_}, constraints_, methodFor(Case::kKind)};

  Eigen::VectorXd deformed() {
    Eigen::VectorXd state = Eigen::VectorXd::Zero(body_->stateSize());
    Eigen::VectorXd free = randomVector(system_.freeSize(), 0.01);
    system_.addTo(state, free, {Case::kDim == 2 ? 0 : 0.02, 0, -0.05});
    return state;
  }

  /// The same equations, dense: K of all entries, then the constraints by a projection.
  void expectAgreesWithDense(EquilibriumSystem& system, const Eigen::MatrixXd& K) {
    const int free = system.freeSize();
    Eigen::MatrixXd Q(K.rows(), free + 3);
    for (int i = 0; i < free + 3; ++i) {
      Eigen::VectorXd column = Eigen::VectorXd::Zero(K.rows());
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(free + 3, i);
      system.addTo(column, unit.head(free), unit.tail<3>());
      Q.col(i) = column;
    }
    const Eigen::MatrixXd reduced = Q.transpose() * K * Q;
    const Eigen::PartialPivLU<Eigen::MatrixXd> K_ff(reduced.topLeftCorner(free, free));
    const Eigen::MatrixXd K_ft = reduced.topRightCorner(free, 3);
    const Eigen::MatrixXd sensitivity = -K_ff.solve(K_ft);
    const Eigen::Matrix3d condensed = reduced.bottomRightCorner<3, 3>() + K_ft.transpose() * sensitivity;
    EXPECT_LT((system.stiffness() - condensed).norm(), 1e-10 * condensed.norm());
    EXPECT_EQ(system.stiffness(), system.stiffness().transpose());
    EXPECT_LT((system.sensitivity() - sensitivity).norm(), 1e-10 * sensitivity.norm());
    const Eigen::VectorXd right = randomVector(free, 1);
    const Eigen::VectorXd solution = K_ff.solve(right);
    EXPECT_LT((system.solve(right) - solution).norm(), 1e-9 * solution.norm());
  }
};

TYPED_TEST_SUITE(EquilibriumSystemTest, AllElements, ElementCaseName);

TYPED_TEST(EquilibriumSystemTest, CondensationIsThatOfTheDenseSystem) {
  const Eigen::VectorXd state = this->deformed();
  ASSERT_TRUE(this->system_.factorise(state));
  this->expectAgreesWithDense(this->system_, hessianOf(*this->body_, state));
}

TYPED_TEST(EquilibriumSystemTest, TermsAddUpAndMayDependOnTheTip) {
  if constexpr (TypeParam::kDim == 3) {
    const auto& body = *this->body_;
    Constraints constraints = freeBody(body);  // nothing sticks: two springs alone pull
    hold(
        body, [](const Eigen::Vector3d& x) { return x.z() == 0; }, constraints);
    const auto one = std::make_shared<TipSpring>(9, body.tipEntry(), 3),
               other = std::make_shared<TipSpring>(24, body.tipEntry(), 5);
    EquilibriumSystem system({this->body_, one, other}, constraints, methodFor(body.kind()));
    const Eigen::VectorXd state = 0.3 * this->deformed();
    ASSERT_TRUE(system.factorise(state));
    Eigen::MatrixXd K = hessianOf(body, state);
    LocalEnergy local;
    double energy = 0, expected = 0, sum = 0;
    for (const auto& spring : {one, other}) {
      ASSERT_TRUE(spring->evaluate(0, state, Order::kHessian, local));
      expected += local.energy;
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) K(spring->entries(0)[i], spring->entries(0)[j]) += local.hessian(i, j);
      }
    }
    this->expectAgreesWithDense(system, K);
    EquilibriumSystem alone({this->body_}, constraints, methodFor(body.kind()));
    ASSERT_TRUE(system.energy(state, energy) && alone.energy(state, sum));
    EXPECT_NEAR(energy, sum + expected, 1e-13 * std::abs(energy));
    Eigen::VectorXd free;
    Eigen::Vector3d reaction;
    ASSERT_TRUE(system.residual(state, free, reaction));
    const Eigen::Vector3d tip = state.segment<3>(body.tipEntry());
    const Eigen::Vector3d pull = 3 * (tip - state.segment<3>(27)) + 5 * (tip - state.segment<3>(72));
    EXPECT_LT((reaction - pull).norm(), 1e-13 * pull.norm());
  }
}

TYPED_TEST(EquilibriumSystemTest, ResidualCollectsFreeForcesAndTheReaction) {
  const Eigen::VectorXd state = this->deformed(), force = gradientOf(*this->body_, state);
  Eigen::VectorXd free;
  Eigen::Vector3d reaction, expected = Eigen::Vector3d::Zero();
  ASSERT_TRUE(this->system_.residual(state, free, reaction));
  EXPECT_EQ(free.size(), this->system_.freeSize());
  double squared = 0;
  for (int i = 0; i < force.size(); ++i) {
    const int kind = this->constraints_.entries[i];
    if (kind >= 0) squared += force[i] * force[i];
    for (int k = 0; k < 3; ++k) expected[k] += kind == Constraints::tip(k) ? force[i] : 0;
  }
  EXPECT_LT((reaction - expected).norm(), 1e-13 * expected.norm());
  EXPECT_LT(reaction.z(), 0);  // what holds the plate down
  EXPECT_NEAR(free.squaredNorm(), squared, 1e-12 * squared);
}

TYPED_TEST(EquilibriumSystemTest, TangentOfACrushedStVenantKirchhoffIsNotPositiveDefinite) {
  constexpr int kDim = TypeParam::kDim;
  const auto soft = makeBody(irregularBlock<kDim>(2), TypeParam::kKind, "st_venant_kirchhoff", 0.3);
  EquilibriumSystem system({soft}, betweenPlates(*soft), methodFor(TypeParam::kKind));
  using Point = typename QuadraticMesh<kDim>::Point;
  const auto crushed = [](const Point& x) { return Point(-0.6 * x[kDim - 1] * Point::Unit(kDim - 1)); };
  EXPECT_TRUE(system.factorise(Eigen::VectorXd::Zero(soft->stateSize())));
  EXPECT_FALSE(system.factorise(stateOf(*soft, crushed)));
  EXPECT_TRUE(system.factorise(Eigen::VectorXd::Zero(soft->stateSize())));  // and it recovers
}

TYPED_TEST(EquilibriumSystemTest, InvertedIsNotAdmissible) {
  constexpr int kDim = TypeParam::kDim;
  using Point = typename QuadraticMesh<kDim>::Point;
  const auto through = [](const Point& x) { return Point(-1.1 * x[kDim - 1] * Point::Unit(kDim - 1)); };
  const Eigen::VectorXd state = stateOf(*this->body_, through);
  Eigen::VectorXd free;
  Eigen::Vector3d reaction;
  double energy = 0;
  EXPECT_FALSE(this->system_.energy(state, energy));
  EXPECT_FALSE(this->system_.residual(state, free, reaction));
  EXPECT_FALSE(this->system_.assemble(state));
  EXPECT_FALSE(this->system_.factorise(state));
}

TYPED_TEST(EquilibriumSystemTest, SettledPressuresAreStationary) {
  if constexpr (TypeParam::kKind == ElementKind::kP2P0) {
    Eigen::VectorXd state = this->deformed(), free;
    Eigen::Vector3d reaction;
    ASSERT_TRUE(this->system_.assemble(state));
    ASSERT_TRUE(this->system_.settleInternal(state));
    ASSERT_TRUE(this->system_.residual(state, free, reaction));
    const int pressures = this->body_->pressureCount();
    EXPECT_LT(free.tail(pressures).norm(), 1e-12 * free.norm());
    EXPECT_GT(free.head(free.size() - pressures).norm(), 0.1 * free.norm());
  }
}

TYPED_TEST(EquilibriumSystemTest, RefusesNothingFree) {
  Constraints constraints = this->constraints_;
  for (int& entry : constraints.entries) entry = Constraints::kFixed;
  EXPECT_THROW(EquilibriumSystem({this->body_}, constraints, methodFor(TypeParam::kKind)), std::invalid_argument);
}

/// A spring from a node to the tip that is taut or slack: its tangent jumps.
class SwitchingSpring : public TipSpring {
 public:
  SwitchingSpring(int node, int tip_entry, double stiffness, bool nonsmooth)
      : TipSpring(node, tip_entry, stiffness), nonsmooth_(nonsmooth) {}
  bool isNonsmooth(int element) const override { return nonsmooth_ && element == 0; }
  bool evaluate(int element, const Eigen::VectorXd& state, Order order, LocalEnergy& result) const override {
    TipSpring::evaluate(element, state, order, result);
    result.zero = result.zero || !taut;
    return true;
  }
  bool taut = false;

 private:
  bool nonsmooth_;
};

/// Blocks of P2-P0 elements between plates, with a spring to the tip at one of the free nodes.
struct SpringSystem {
  explicit SpringSystem(bool nonsmooth) {
    const Constraints constraints = betweenPlates(*body);
    int node = 0;
    while (constraints.entries[3 * node] != Constraints::kFree) ++node;
    spring = std::make_shared<SwitchingSpring>(node, body->tipEntry(), 50, nonsmooth);
    system = std::make_unique<EquilibriumSystem>(EquilibriumSystem::Terms{body, spring}, constraints,
                                                 SymmetricSolver::Method::kSupernodal);
    state.setZero(body->stateSize());
  }
  std::shared_ptr<LayeredBody<3>> body = makeBody(irregularBlock<3>(2), ElementKind::kP2P0, "neo_hookean", 0.4);
  std::shared_ptr<SwitchingSpring> spring;
  std::unique_ptr<EquilibriumSystem> system;
  Eigen::VectorXd state;
};

TEST(EquilibriumSystem, RefreshingFollowsASpringThatBecomesTautAndSlack) {
  SpringSystem at(true);
  ASSERT_TRUE(at.system->factorise(at.state));
  const Eigen::VectorXd right = randomVector(at.system->freeSize(), 1);
  const Eigen::VectorXd slack = at.system->solve(right);
  EXPECT_FALSE(at.system->refresh(at.state)) << "nothing has changed";
  at.spring->taut = true;
  ASSERT_TRUE(at.system->refresh(at.state));
  const Eigen::VectorXd refreshed = at.system->solve(right);
  ASSERT_TRUE(at.system->factorise(at.state));
  const Eigen::VectorXd taut = at.system->solve(right);
  EXPECT_GT((taut - slack).norm(), 1e-2 * slack.norm()) << "the spring must matter";
  EXPECT_LT((refreshed - taut).norm(), 1e-10 * taut.norm());
  at.spring->taut = false;
  ASSERT_TRUE(at.system->refresh(at.state));
  EXPECT_LT((at.system->solve(right) - slack).norm(), 1e-10 * slack.norm());
}

TEST(EquilibriumSystem, RefreshingIsImpossibleWhereASmoothElementHasChanged) {
  SpringSystem at(false);
  ASSERT_TRUE(at.system->factorise(at.state));
  at.spring->taut = true;
  EXPECT_FALSE(at.system->refresh(at.state));
}

}  // namespace
}  // namespace microinjection
