#include "cell/pose/cell_hold.h"

#include <gtest/gtest.h>

#include <cmath>

#include "motion_scene.h"

namespace microinjection {
namespace {

constexpr double kCellRadius = 28e-6, kTipRadius = 3e-6, kStep = 1e-3, kSuction = -2000;
constexpr double kStiffness = 0.05;  // N/m, of the model of the tests: a spring where the tip is in the cell

/// A cell at its holding pipette, and a model of it: a linear spring along z below the pole.
class HeldSphere : public ::testing::Test {
 protected:
  static CellMotionConfig config() {
    CellMotionConfig config;
    config.radius = kCellRadius;
    return config;
  }
  HeldSphere()
      : hold_(config(), PipetteMouth(kBoreRadius, kTubeRadius, 2.5e-6, 1), RoundedTip(kTipRadius, kTipRadius)) {}

  /// The force of the model for the tip there.
  static Eigen::Vector3d model(const Eigen::Vector3d& tip, const Eigen::Vector3d& offset) {
    const Eigen::Vector3d at = tip - offset;
    return at.head<2>().norm() < kCellRadius && at.z() < kCellRadius && at.z() > 0
               ? Eigen::Vector3d(0, 0, kStiffness * (kCellRadius - at.z()))
               : Eigen::Vector3d::Zero();
  }
  void stepTo(const Eigen::Vector3d& tip) {
    if (!input_.needle) input_.needle.emplace();
    input_.needle->tip = tip;
    hold_.step(kStep, input_);
    force_ = hold_.forceOnNeedle(model(tip, hold_.state().offset));
  }
  void rest(int steps) {
    for (int i = 0; i < steps; ++i) {
      hold_.step(kStep, input_);
      force_ = hold_.forceOnNeedle(input_.needle ? model(input_.needle->tip, hold_.state().offset)
                                                 : Eigen::Vector3d::Zero());
    }
  }
  /// Moves the tip in a straight line, at 30 um/s.
  void moveTo(const Eigen::Vector3d& goal) {
    const Eigen::Vector3d from = input_.needle->tip;
    const int steps = std::max(1, static_cast<int>((goal - from).norm() / 30e-9));
    for (int i = 1; i <= steps; ++i) stepTo(from + double(i) / steps * (goal - from));
  }

  CellHold hold_;
  CellHold::Input input_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero();
};

TEST_F(HeldSphere, isThatOfTheModelBitForBitWhileTheSuctionBears) {
  input_.pressure = kSuction;
  stepTo({0, 0, kCellRadius + 1e-6});
  EXPECT_EQ(hold_.state().mode, CellMode::kHeld);
  for (double depth = 0; depth < 10e-6; depth += 0.1e-6) {
    const Eigen::Vector3d tip(0, 0, kCellRadius - depth);
    stepTo(tip);
    EXPECT_EQ(force_, model(tip, Eigen::Vector3d::Zero()));
    EXPECT_EQ(hold_.state().offset, Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(hold_.state().limit, INFINITY) << "the needle presses it onto the lip";
}

TEST_F(HeldSphere, followsItsPipette) {
  input_.pressure = kSuction;
  stepTo({0, 0, 60e-6});
  for (int i = 0; i < 1000; ++i) {
    input_.mouth += Eigen::Vector3d(20e-9, 10e-9, -5e-9);
    rest(1);
  }
  EXPECT_EQ(hold_.state().mode, CellMode::kHeld);
  EXPECT_LT((hold_.state().offset - Eigen::Vector3d(20e-6, 10e-6, -5e-6)).norm(), 1e-12);
}

TEST_F(HeldSphere, fallsOntoTheDishWithoutSuction) {
  CellMotionConfig config = HeldSphere::config();
  config.dish_height = -20e-6;
  CellHold hold(config, PipetteMouth(kBoreRadius, kTubeRadius, 2.5e-6, 1), RoundedTip(kTipRadius, kTipRadius));
  for (int i = 0; i < 20000; ++i) hold.step(kStep, {});
  EXPECT_EQ(hold.state().mode, CellMode::kResting);
  EXPECT_NEAR(hold.state().offset.y(), -20e-6, 0.3e-6);
  CellHold::Input suck;
  suck.pressure = kSuction;
  suck.mouth = hold.state().offset;  // the operator lowers the pipette to the cell
  for (int i = 0; i < 2000; ++i) hold.step(kStep, suck);
  EXPECT_EQ(hold.state().mode, CellMode::kHeld);
  EXPECT_TRUE(hold.state().sealed);
  EXPECT_EQ(hold.state().seal_resistance, INFINITY);
}

TEST_F(HeldSphere, isTakenByASuctionThatGrows) {
  stepTo({0, 0, 60e-6});
  rest(50);
  EXPECT_NE(hold_.state().mode, CellMode::kHeld);
  for (int i = 0; i < 500; ++i) {
    input_.pressure = std::max(-1300.0, input_.pressure - 5);
    rest(1);
  }
  EXPECT_EQ(hold_.state().mode, CellMode::kHeld);
}

TEST_F(HeldSphere, losesACellThatIsPulledHarderThanTheSuctionBears) {
  input_.pressure = kSuction;
  // A needle in the cell draws it off: the model's force on the needle holds it back.
  input_.needle = CellHold::Needle{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), true};
  hold_.step(kStep, input_);
  const PipetteMouth mouth(kBoreRadius, kTubeRadius, 2.5e-6, 1);
  const double bears = CellMotion(config(), mouth, std::nullopt).limits(kSuction).pull();
  EXPECT_NEAR(bears, -kSuction * M_PI * std::pow(mouth.touchRadius(kCellRadius), 2), 0.2 * bears);
  for (double pull = 0; pull < 0.99 * bears; pull += 0.01 * bears) {
    hold_.forceOnNeedle({0, 0, -pull});
    hold_.step(kStep, input_);
    ASSERT_EQ(hold_.state().mode, CellMode::kHeld) << pull / bears;
    EXPECT_DOUBLE_EQ(hold_.state().limit, pull > 0 ? bears : INFINITY);
  }
  hold_.forceOnNeedle({0, 0, -1.01 * bears});
  for (int i = 0; i < 200; ++i) {
    input_.needle->tip.z() += 0.1e-6;
    hold_.step(kStep, input_);
    hold_.forceOnNeedle({0, 0, -1.01 * bears});
  }
  EXPECT_EQ(hold_.state().mode, CellMode::kCarried);
  EXPECT_NEAR(hold_.state().offset.z(), 20e-6, 0.2e-6);
  EXPECT_FALSE(hold_.state().sealed);
  EXPECT_LT(hold_.forceOnNeedle({0, 0, -1.01 * bears}).norm(), 1e-3 * bears) << "nothing holds it";
  // Back at the mouth it is held again.
  for (int i = 0; i < 250; ++i) {
    input_.needle->tip.z() -= 0.1e-6;
    hold_.step(kStep, input_);
    hold_.forceOnNeedle(Eigen::Vector3d::Zero());
  }
  EXPECT_EQ(hold_.state().mode, CellMode::kHeld);
}

TEST_F(HeldSphere, slipsUnderANeedleBesideTheAxisAndTheForceHasNoJumps) {
  input_.pressure = -200;
  stepTo({18e-6, 0, kCellRadius + 1e-6});
  double before = 0, largest_change = 0, largest = 0;
  CellMode worst = CellMode::kHeld;
  for (int i = 0; i < 1500; ++i) {
    stepTo({18e-6, 0, kCellRadius + 1e-6 - i * 20e-9});
    largest_change = std::max(largest_change, std::abs(force_.norm() - before));
    before = force_.norm();
    largest = std::max(largest, before);
    if (hold_.state().mode != CellMode::kHeld) worst = hold_.state().mode;
    ASSERT_TRUE(hold_.state().offset.allFinite());
  }
  EXPECT_NE(worst, CellMode::kHeld);
  EXPECT_LT(hold_.state().offset.x(), -1e-6) << "it has given way";
  EXPECT_LT(largest_change, 0.1 * largest) << "in a step of 20 nm";
}

TEST_F(HeldSphere, keepsItsTurnWhenItIsHeldAndLostAgain) {
  input_.pressure = -200;
  stepTo({18e-6, 0, kCellRadius + 1e-6});
  for (int i = 0; i < 1500; ++i) stepTo({18e-6, 0, kCellRadius + 1e-6 - i * 20e-9});
  input_.needle.reset();
  input_.pressure = kSuction;
  rest(500);
  ASSERT_EQ(hold_.state().mode, CellMode::kHeld);
  const Eigen::Quaterniond turned = hold_.state().orientation;
  EXPECT_GT(turned.angularDistance(Eigen::Quaterniond::Identity()), 0.02);
  input_.pressure = 0;
  rest(1);
  EXPECT_NE(hold_.state().mode, CellMode::kHeld);
  EXPECT_LT(turned.angularDistance(hold_.state().orientation), 1e-3);
}

TEST_F(HeldSphere, aNeedleThatWasAwayFeelsNothingOfBefore) {
  input_.pressure = kSuction;
  for (int i = 0; i < 300; ++i) stepTo({0, 0, kCellRadius - i * 20e-9});
  input_.needle.reset();
  rest(5);
  EXPECT_EQ(hold_.state().load, 0);
  stepTo({0, 0, 60e-6});
  EXPECT_EQ(force_, Eigen::Vector3d::Zero());
  EXPECT_TRUE(std::isnan(hold_.forceOnNeedle({0, 0, NAN}).z()));
  stepTo({0, 0, 60e-6});
  EXPECT_EQ(force_, Eigen::Vector3d::Zero()) << "and of no number";
}

TEST_F(HeldSphere, doesNotUseAnInputThatIsNotFinite) {
  input_.pressure = kSuction;
  stepTo({0, 0, 60e-6});
  input_.mouth.x() = NAN;
  hold_.step(kStep, input_);
  EXPECT_EQ(hold_.state().offset, Eigen::Vector3d::Zero());
  input_.mouth.setZero();
  input_.pressure = NAN;
  hold_.step(kStep, input_);
  EXPECT_EQ(hold_.state().mode, CellMode::kHeld);
}

}  // namespace
}  // namespace microinjection
