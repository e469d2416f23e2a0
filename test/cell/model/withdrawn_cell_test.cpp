#include "cell/model/withdrawn_cell.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "spring_cell.h"

namespace microinjection {
namespace {

constexpr double kRadius = 28e-6, kStiffness = 0.05, kTip = 3e-6;  // m, N/m, m
constexpr double kPull = 0.3e-6, kFall = 0.2e-6;                   // m
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

double made(double x, double adhesion, double turn) {
  return (0.2 * std::sin(M_PI * x) + adhesion * (1 - x)) * (1.4 - 0.4 * std::sqrt(turn / 14e-6));
}

WithdrawalLoss madeLoss(double adhesion) {
  std::vector<WithdrawalLoss::Turn> turns;
  for (const double depth : {1e-6, 4e-6, 9e-6, 14e-6}) {
    WithdrawalLoss::Turn turn{depth, kPull, kFall, 5 * depth, Eigen::VectorXd(WithdrawalLoss::kKnots)};
    for (int i = 0; i < WithdrawalLoss::kKnots; ++i)
      turn.shares[i] = made(i / (WithdrawalLoss::kKnots - 1.0), adhesion, depth);
    turns.push_back(turn);
  }
  return {turns, 0.01};
}

TEST(WithdrawalLoss, IsThatOfItsTurns) {
  const WithdrawalLoss loss = madeLoss(0.1);
  for (const double turn : {1e-6, 2.3e-6, 9e-6, 14e-6}) {
    for (int i = 0; i < WithdrawalLoss::kKnots; ++i) {
      const double expected = made(i / (WithdrawalLoss::kKnots - 1.0), 0.1, turn);
      EXPECT_NEAR(loss.share(WithdrawalLoss::depthOf(i, turn, kPull), turn), expected, 1e-3) << i << " of " << turn;
    }
    EXPECT_EQ(loss.share(turn, turn), 0);
    EXPECT_EQ(loss.share(2 * turn, turn), 0);
    EXPECT_NEAR(loss.share(-kPull - kFall, turn), 0.5 * loss.share(-kPull, turn), 1e-6);
    EXPECT_NEAR(loss.share(-loss.reach(turn), turn), 0, 2e-4);
  }
  EXPECT_EQ(madeLoss(0).reach(5e-6), 0);
  EXPECT_THROW(WithdrawalLoss({}, 0), std::invalid_argument);
}

class WithdrawnCellTest : public testing::Test {
 protected:
  void make(double adhesion) {
    auto spring = std::make_unique<SpringCell>(kRadius, kStiffness);
    inner_ = spring.get();
    inner_->snap = 1e-9;
    cell_ = std::make_unique<WithdrawnCell>(std::move(spring), madeLoss(adhesion), kTip);
  }
  /// N, along the pipette.
  double at(double depth, double beside = 0) {
    const TipForce force = cell_->step({beside, 0, kRadius - depth}, kUp, time_ += 1e-3);
    return force.force.z();
  }
  double to(double from, double depth) {
    double force = 0;
    for (int i = 1; i <= 200; ++i) force = at(from + (depth - from) * i / 200);
    return force;
  }

  SpringCell* inner_ = nullptr;
  std::unique_ptr<WithdrawnCell> cell_;
  double time_ = 0;
};

TEST_F(WithdrawnCellTest, TheWayOutHasLess) {
  make(0);
  const double turn = 8e-6, force = kStiffness * turn;
  EXPECT_NEAR(to(0, turn), force, 1e-12);
  const int knot = WithdrawalLoss::kKnots / 2;
  const double depth = WithdrawalLoss::depthOf(knot, turn, kPull);
  EXPECT_NEAR(to(turn, depth), kStiffness * depth - made(knot / (WithdrawalLoss::kKnots - 1.0), 0, turn) * force,
              1e-3 * force);
  EXPECT_EQ(to(depth, -1e-9), 0);
  EXPECT_FALSE(cell_->contact());
  EXPECT_NEAR(to(0, 2e-6), kStiffness * 2e-6, 1e-12) << "a new touch is a way in";
}

TEST_F(WithdrawnCellTest, AFurtherWayInComesBackToTheFirst) {
  make(0);
  const double turn = 8e-6, half = 3e-6;
  to(0, turn);
  const double out = to(turn, half);
  EXPECT_LT(out, kStiffness * half);
  EXPECT_NEAR(at(half + 1e-9), out, 1e-3 * kStiffness * turn) << "no jump";
  const double back = half + 1.01 * WithdrawnCell::kReversal * turn;
  EXPECT_NEAR(to(half + 1e-9, back), kStiffness * back, 1e-12);
  EXPECT_NEAR(to(back, 1.2 * turn), kStiffness * 1.2 * turn, 1e-12);
}

TEST_F(WithdrawnCellTest, AdhesionPullsAboveFirstContactUntilItEnds) {
  make(0.1);
  const double force = to(0, 8e-6), pull = made(0, 0.1, 8e-6) * force;
  EXPECT_NEAR(to(8e-6, -kPull), -pull, 1e-3 * force);
  ASSERT_TRUE(cell_->contact());
  EXPECT_NEAR(cell_->contact()->indentation, -kPull, 1e-12);
  EXPECT_NEAR(to(-kPull, -kPull - kFall), -0.5 * pull, 1e-3 * force);
  EXPECT_EQ(to(-kPull - kFall, -5e-6), 0);
  EXPECT_FALSE(cell_->contact());
  EXPECT_EQ(at(-kPull), 0) << "it has parted";
}

TEST_F(WithdrawnCellTest, AdhesionEndsBesideThePlace) {
  make(0.1);
  to(0, 8e-6);
  EXPECT_LT(to(8e-6, -kPull), 0);
  EXPECT_LT(at(-kPull, 0.9 * kTip), 0);
  EXPECT_EQ(at(-kPull, 1.1 * kTip), 0);
  EXPECT_FALSE(cell_->contact());
}

TEST_F(WithdrawnCellTest, TheErrorOfTheLossIsAdded) {
  make(0.1);
  EXPECT_FALSE(cell_->forceError());
  inner_->error = 1e-9;
  const double force = to(0, 8e-6);
  EXPECT_EQ(cell_->forceError(), 1e-9) << "of the way in";
  to(8e-6, 5e-6);
  EXPECT_NEAR(cell_->forceError().value(), std::hypot(1e-9, 0.01 * force), 1e-15);
  at(5e-6, 0.5 * kTip);
  EXPECT_FALSE(cell_->forceError()) << "beside the axis the loss is not known";
  cell_->release();
  const double aside = 10e-6, top = std::sqrt(kRadius * kRadius - aside * aside) - kRadius;
  for (const double depth : {-1e-6, 3e-6, 2e-6}) at(depth - top, aside);
  EXPECT_FALSE(cell_->forceError()) << "nor where it has touched beside it";
}

TEST_F(WithdrawnCellTest, ATouchWithoutDepthHasAForce) {
  for (const double adhesion : {0.0, 0.1}) {
    make(adhesion);
    at(1e-30);
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(at(-1e-12))) << i;
    EXPECT_NEAR(to(0, 4e-6), kStiffness * 4e-6, 1e-12);
  }
}

TEST_F(WithdrawnCellTest, NothingPullsWithoutAdhesionOffTheSurface) {
  make(0);
  const double aside = 15e-6, top = std::sqrt(kRadius * kRadius - aside * aside) - kRadius;
  for (const double depth : {-1e-6, 4e-6, 2e-6}) at(depth - top, aside);
  EXPECT_EQ(at(1e-6 - top, aside + 2e-6), 0) << "the surface falls away to the side";
  EXPECT_FALSE(cell_->contact());
}

TEST_F(WithdrawnCellTest, ReleaseForgetsTheTurn) {
  make(0.1);
  to(0, 8e-6);
  cell_->release();
  EXPECT_EQ(inner_->released, 1);
  EXPECT_EQ(at(-kPull), 0);
}

TEST_F(WithdrawnCellTest, AnInvalidForceStaysOne) {
  make(0.1);
  to(0, 8e-6);
  inner_->valid = false;
  const TipForce force = cell_->step({0, 0, kRadius - 4e-6}, kUp, time_ += 1e-3);
  EXPECT_FALSE(force.valid);
  EXPECT_TRUE(force.force.isZero(0));
}

/// The needle's work less what the spring stores never falls below 0, whatever its way.
TEST_F(WithdrawnCellTest, IsPassive) {
  std::mt19937 random(1);
  const auto uniform = [&] { return random() / 4294967296.0; };
  for (const double adhesion : {0.0, 0.1}) {
    make(adhesion);
    double lost = 0, lowest = 0, scale = 0, whole = 0;
    int touches = 0;
    Eigen::Vector3d last(0, 0, kRadius), last_force = Eigen::Vector3d::Zero();
    for (int way = 0; way < 400; ++way) {
      // Up and down in a bundle that never leaves the contact sideways: the spring is one of one touch.
      const double depth = (uniform() < 0.2 ? -3e-6 : 14e-6 * uniform()), beside = 1e-6 * uniform();
      const Eigen::Vector3d from = last, goal(depth > 0 ? beside : last.x(), 0, kRadius - depth);
      for (int i = 1; i <= 200; ++i) {
        const Eigen::Vector3d tip = from + (goal - from) * i / 200;
        const Eigen::Vector3d total = cell_->step(tip, kUp, time_ += 1e-3).force;
        const auto& touch = inner_->contact();
        const Eigen::Vector3d spring =
            touch ? Eigen::Vector3d(-kStiffness * touch->displacement) : Eigen::Vector3d::Zero();
        const Eigen::Vector3d own = total - spring;  // what the cell under test adds
        const double work = -0.5 * (own + last_force).dot(tip - last);
        lost += work;
        whole += work;
        lowest = std::min(lowest, lost);
        if (!cell_->contact() && last_force.isZero(0)) {  // out: what was lost on former ways pays for nothing
          touches += lost != 0;
          lost = 0;
        }
        scale = std::max(scale, own.norm() * 14e-6);
        last = tip;
        last_force = own;
      }
    }
    EXPECT_GT(whole, 10 * scale) << "it loses";
    EXPECT_GT(touches, 20);
    EXPECT_GT(lowest, -1e-3 * scale);
  }
}

}  // namespace
}  // namespace microinjection
