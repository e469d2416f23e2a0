#include "cell/mechanics/load_path.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/finite_difference.h"
#include "cell/mechanics/bodies.h"

namespace microinjection {
namespace {

LoadPathConfig pathConfig(double length, bool linear) {
  LoadPathConfig config;
  config.length = length;
  config.first_step = config.largest_step = length / 16;
  config.smallest_step = 1e-5 * length;
  config.linear = linear;
  return config;
}

/// A block of size 1 held at its bottom; its whole top moves.
template <int Dim>
struct PressedBlock {
  PressedBlock(ElementKind kind, const std::string& model, double poisson_ratio)
      : body(makeBody(irregularBlock<Dim>(2), kind, model, poisson_ratio)),
        system({body}, betweenPlates(*body), methodFor(kind)),
        path(system, pathConfig(1, body->isLinear())) {}

  std::shared_ptr<LayeredBody<Dim>> body;
  EquilibriumSystem system;
  LoadPath path;
};

template <typename Case>
class LoadPathTest : public testing::Test {
 protected:
  using Block = PressedBlock<Case::kDim>;

  /// In a section the tip stays on the axis.
  static Eigen::Vector3d point() {
    return Case::kDim == 2 ? Eigen::Vector3d(0, 0, -0.2) : Eigen::Vector3d(0.1, -0.05, -0.2);
  }

  /// The components that the tip has.
  static Eigen::VectorXd tip(const Eigen::Vector3d& v) {
    return Case::kDim == 2 ? Eigen::VectorXd(v.tail<1>()) : Eigen::VectorXd(v);
  }
  static Eigen::Vector3d translation(const Eigen::VectorXd& v) {
    return Case::kDim == 2 ? Eigen::Vector3d(0, 0, v[0]) : Eigen::Vector3d(v);
  }

  /// Residual where the path is, relative to the reaction at the point.
  static double residual(Block& block) {
    Eigen::VectorXd free;
    Eigen::Vector3d reaction;
    EXPECT_TRUE(block.system.residual(block.path.state(), free, reaction));
    return free.norm();
  }
};

TYPED_TEST_SUITE(LoadPathTest, AllElements, ElementCaseName);

TYPED_TEST(LoadPathTest, UniformCompressionIsExact) {
  // nu = 0: nothing moves sideways, so that the block is in uniaxial strain, and F is diag(1, 1, s).
  struct Expected {
    std::string model;
    double s, stress;
  };
  const double area = TypeParam::kDim == 2 ? M_PI : 1;
  // St-Venant-Kirchhoff: less, since mixed elements lose stability before the material does where lambda < mu.
  for (const Expected& expected : {Expected{"linear", 0.7, 2 * (0.7 - 1)},
                                   {"neo_hookean", 0.7, 0.7 - 1 / 0.7},
                                   {"ogden", 0.7, (std::pow(0.7, 3) - 1 / 0.7) / 2},
                                   {"st_venant_kirchhoff", 0.8, 0.8 * (0.64 - 1)}}) {
    SCOPED_TRACE(expected.model);
    const Eigen::Vector3d target(0, 0, expected.s - 1);
    typename TestFixture::Block block(TypeParam::kKind, expected.model, 0);
    const LoadPath::Result result = block.path.advance(target);
    ASSERT_TRUE(result.converged) << result.reason;
    EXPECT_EQ(block.path.translation(), target);
    EXPECT_NEAR(block.path.reaction().z(), area * expected.stress, 1e-7);
    EXPECT_NEAR(block.path.reaction().template head<2>().norm(), 0, 1e-7);
    EXPECT_NEAR(block.body->smallestJacobian(block.path.state()), expected.s, 1e-7);
  }
}

TYPED_TEST(LoadPathTest, StiffnessIsTheDerivativeOfTheReactionAndThatOfTheEnergy) {
  typename TestFixture::Block block(TypeParam::kKind, "neo_hookean", 0.45);
  const Eigen::Vector3d point = this->point();
  ASSERT_TRUE(block.path.advance(point).converged);
  const Eigen::Matrix3d stiffness = block.path.stiffness();
  const Eigen::Vector3d force = block.path.reaction();
  EXPECT_EQ(stiffness, stiffness.transpose());
  const auto reaction = [&](const Eigen::VectorXd& at) {
    EXPECT_TRUE(block.path.advance(this->translation(at)).converged);
    return this->tip(block.path.reaction());
  };
  const auto energy = [&](const Eigen::VectorXd& at) {
    EXPECT_TRUE(block.path.advance(this->translation(at)).converged);
    return Eigen::VectorXd(Eigen::VectorXd::Constant(1, block.path.energy()));
  };
  const Eigen::VectorXd at = this->tip(point);
  EXPECT_LT(derivativeError(reaction, at, stiffness.bottomRightCorner(at.size(), at.size()), 1e-4), 1e-5);
  EXPECT_LT(derivativeError(energy, at, this->tip(force).transpose(), 1e-4), 1e-6);
}

/// A step that leaves the limit of Gent's material is refused like one that inverts an element: the path ends before
/// it, where the force grows without bound, and can be gone back.
TYPED_TEST(LoadPathTest, EndsBeforeTheLimitOfItsMaterial) {
  constexpr int kDim = TypeParam::kDim;
  MaterialConfig config{"gent", 2, 0.45};
  config.gent_limit = 0.5;
  const auto mesh = irregularBlock<kDim>(2);
  typename LayeredBody<kDim>::Materials materials{makeMaterial(config)};
  const auto body = std::make_shared<LayeredBody<kDim>>(mesh, TypeParam::kKind, std::move(materials));
  EquilibriumSystem system({body}, betweenPlates(*body), methodFor(TypeParam::kKind));
  LoadPath path(system, pathConfig(1, false));
  ASSERT_TRUE(path.advance({0, 0, 0.1}).converged);
  const double early = path.reaction().z();
  const LoadPath::Result result = path.advance({0, 0, 3});
  EXPECT_FALSE(result.converged);
  EXPECT_FALSE(result.reason.empty());
  double largest = 0;  // I1 - 3
  for (int e = 0; e < body->elementCount(); ++e) {
    for (int q = 0; q < body->pointCount(); ++q)
      largest = std::max(largest, body->deformationGradient(e, q, path.state()).squaredNorm() - 3);
  }
  EXPECT_LT(largest, config.gent_limit);
  EXPECT_GT(largest, 0.9 * config.gent_limit);
  EXPECT_GT(path.translation().z(), 0.2);
  EXPECT_LT(path.translation().z(), 1);
  EXPECT_GT(path.reaction().z(), 20 * early);
  ASSERT_TRUE(path.advance({0, 0, 0.1}).converged);
  EXPECT_NEAR(path.reaction().z(), early, 1e-6 * early);
}

TYPED_TEST(LoadPathTest, AClosedCycleGivesAllEnergyBackAndLeavesNoForce) {
  typename TestFixture::Block block(TypeParam::kKind, "neo_hookean", 0.45);
  double peak = 0, force = 0, deformed = 0;
  const Eigen::Vector3d way[] = {this->point(), 1.5 * this->point(), {0, 0, 0.1}, Eigen::Vector3d::Zero()};
  for (const Eigen::Vector3d& target : way) {
    const Eigen::Vector3d start = block.path.translation();
    for (int i = 1; i <= 4; ++i) {
      const Eigen::Vector3d next = i == 4 ? target : Eigen::Vector3d(start + i / 4.0 * (target - start));
      const LoadPath::Result result = block.path.advance(next);
      ASSERT_TRUE(result.converged) << result.reason;
      peak = std::max(peak, block.path.energy());
      force = std::max(force, block.path.reaction().norm());
      deformed = std::max(deformed, block.path.state().norm());
      EXPECT_LT(this->residual(block), 1e-7 * force);
    }
  }
  EXPECT_GT(peak, 0.01);
  EXPECT_LT(std::abs(block.path.energy()), 1e-12 * peak);
  EXPECT_LT(block.path.reaction().norm(), 1e-7 * force);
  EXPECT_LT(block.path.state().norm(), 1e-7 * deformed);
}

TYPED_TEST(LoadPathTest, AJumpGivesTheSameStateAsSmallSteps) {
  constexpr int kDim = TypeParam::kDim;
  const double radius = 28e-6;
  const std::vector<double> radii = {radius, radius / 2};
  const auto mesh = [&] {
    if constexpr (kDim == 2) {
      return makeQuadratic(layeredHalfDisc(12, radii), radii);
    } else {
      return makeQuadratic(layeredBall(1, radii), radii);
    }
  };
  typename LayeredBody<kDim>::Materials materials = {material("neo_hookean", 0.49, 17.9e3),
                                                     material("neo_hookean", 0.49, 5e3)};
  const auto body = std::make_shared<LayeredBody<kDim>>(mesh(), TypeParam::kKind, materials);
  const Constraints constraints = betweenCaps(*body, radius);
  EquilibriumSystem one({body}, constraints, methodFor(TypeParam::kKind)),
      other({body}, constraints, methodFor(TypeParam::kKind));
  LoadPath jumping(one, pathConfig(2 * radius, false)), creeping(other, pathConfig(2 * radius, false));
  const Eigen::Vector3d jump(kDim == 2 ? 0 : 2e-6, 0, -10e-6);
  const LoadPath::Result result = jumping.advance(jump);
  ASSERT_TRUE(result.converged) << result.reason;
  for (int i = 1; i <= 40; ++i) ASSERT_TRUE(creeping.advance(jump * i / 40).converged) << i;
  EXPECT_EQ(creeping.translation(), jumping.translation());
  EXPECT_LT((creeping.state() - jumping.state()).norm(), 1e-6 * jumping.state().norm());
  EXPECT_LT((creeping.reaction() - jumping.reaction()).norm(), 1e-7 * jumping.reaction().norm());
  EXPECT_NEAR(creeping.energy(), jumping.energy(), 1e-7 * jumping.energy());
  EXPECT_GT(jumping.energy(), 1e-13);
}

TEST(LoadPath, StVenantKirchhoffEndsWhereTheStableBranchDoes) {
  // Uniaxial strain at nu = 0: P = s (s^2 - 1) has its extremum, and the bar its last stable state, at s = 1 / sqrt(3).
  PressedBlock<3> cube(ElementKind::kP1, "st_venant_kirchhoff", 0);
  const LoadPath::Result result = cube.path.advance({0, 0, -0.9});
  EXPECT_FALSE(result.converged);
  EXPECT_FALSE(result.reason.empty());
  const double s = 1 + cube.path.translation().z();
  EXPECT_GT(s, 1 / std::sqrt(3.0) - 1e-3);  // never beyond
  EXPECT_LT(s, 0.7);
  EXPECT_NEAR(cube.path.reaction().z(), s * (s * s - 1), 1e-7);  // and a right state where it stopped

  ASSERT_TRUE(cube.path.advance({0, 0, -0.2}).converged);  // from where one can go back
  EXPECT_NEAR(cube.path.reaction().z(), 0.8 * (0.64 - 1), 1e-7);
}

/// One entry in a double well, pulled by the tip through a soft spring: ((u - 1)^2 - 1)^2 / 4 + c/2 (u - t)^2.
class SnappingSpring : public EnergyTerm {
 public:
  static constexpr double kSpring = 0.3;
  int elementCount() const override { return 1; }
  const std::vector<int>& entries(int) const override { return entries_; }
  bool evaluate(int, const Eigen::VectorXd& state, Order, LocalEnergy& result) const override {
    const double x = state[0] - 1, stretch = state[0] - state[1];
    result.energy = 0.25 * (x * x - 1) * (x * x - 1) + 0.5 * kSpring * stretch * stretch;
    result.gradient = Eigen::Vector2d(x * (x * x - 1) + kSpring * stretch, -kSpring * stretch);
    result.hessian = Eigen::Matrix2d::Constant(-kSpring);
    result.hessian.diagonal() = Eigen::Vector2d(3 * x * x - 1 + kSpring, kSpring);
    return true;
  }

 private:
  std::vector<int> entries_ = {0, 1};
};

TEST(LoadPath, DoesNotJumpToAnotherBranch) {
  // The first branch ends in a fold, 3 x^2 = 1 - c; past it there is the other one, stable as well.
  const double c = SnappingSpring::kSpring, x = -std::sqrt((1 - c) / 3), fold = 1 + x + x * (x * x - 1) / c;
  Constraints constraints;
  constraints.entries = {Constraints::kFree, Constraints::tip(0), Constraints::tip(1), Constraints::tip(2)};
  for (const double step : {1.0 / 16, 0.25, 1.0, 3.0}) {
    EquilibriumSystem system({std::make_shared<SnappingSpring>()}, constraints, SymmetricSolver::Method::kSimplicial);
    LoadPathConfig config = pathConfig(1, false);
    config.first_step = config.largest_step = step;
    LoadPath path(system, config);
    const LoadPath::Result result = path.advance({3, 0, 0});
    EXPECT_FALSE(result.converged) << step;
    EXPECT_NE(result.reason, "") << step;
    EXPECT_LT(path.translation().x(), fold + 1e-9) << step;
    EXPECT_GT(path.translation().x(), fold - 0.05) << step;
    EXPECT_LT(path.state()[0], 1 + x + 1e-9) << step;
  }
}

TEST(LoadPath, NothingToDoIsUndeformed) {
  PressedBlock<3> cube(ElementKind::kP1, "neo_hookean", 0.3);
  const LoadPath::Result result = cube.path.advance(Eigen::Vector3d::Zero());
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.newton_iterations, 0);
  EXPECT_EQ(cube.path.reaction().norm(), 0);
  EXPECT_GT(cube.path.stiffness()(2, 2), 0);
}

TEST(LoadPath, ResetForgets) {
  PressedBlock<3> one(ElementKind::kP1, "neo_hookean", 0.3), two(ElementKind::kP1, "neo_hookean", 0.3);
  ASSERT_TRUE(one.path.advance({0.2, 0, -0.3}).converged);
  one.path.reset();
  ASSERT_TRUE(one.path.advance({0, 0, -0.1}).converged);
  ASSERT_TRUE(two.path.advance({0, 0, -0.1}).converged);
  EXPECT_EQ(one.path.state(), two.path.state());  // to the bit
  EXPECT_EQ(one.path.reaction(), two.path.reaction());
}

/// Pushes one entry away from where it is.
class Repulsion : public EnergyTerm {
 public:
  Repulsion(int entry, double stiffness) : entries_{entry}, stiffness_(stiffness) {}
  int elementCount() const override { return 1; }
  const std::vector<int>& entries(int) const override { return entries_; }
  bool evaluate(int, const Eigen::VectorXd& state, Order, LocalEnergy& result) const override {
    const double x = state[entries_[0]];
    result.energy = -0.5 * stiffness_ * x * x;
    result.gradient = Eigen::VectorXd::Constant(1, -stiffness_ * x);
    result.hessian = Eigen::MatrixXd::Constant(1, 1, -stiffness_);
    return true;
  }

 private:
  std::vector<int> entries_;
  double stiffness_;
};

TEST(LoadPath, RefusesWhatIsNotStableUndeformed) {
  const auto body = makeBody(irregularBlock<3>(2), ElementKind::kP1, "neo_hookean", 0.3);
  const Constraints constraints = betweenPlates(*body);
  const int middle = 3 * 13;
  ASSERT_EQ(constraints.entries[middle], Constraints::kFree);
  for (const double stiffness : {0.1, 100.0}) {
    EquilibriumSystem system({body, std::make_shared<Repulsion>(middle, stiffness)}, constraints,
                             SymmetricSolver::Method::kSimplicial);
    if (stiffness < 1) {
      EXPECT_NO_THROW(LoadPath(system, pathConfig(1, false)));
    } else {
      EXPECT_THROW(LoadPath(system, pathConfig(1, false)), std::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace microinjection
