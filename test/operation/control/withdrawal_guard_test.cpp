// By hand, at a limit of force or depth: what a noisy force, or one that cannot be, does to the needle.

#include "operation/control/withdrawal_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "operation/control/injection_controller.h"

namespace microinjection {
namespace {

const Eigen::Vector3d kAxis = Eigen::Vector3d::UnitZ();

class WithdrawalGuardTest : public testing::Test {
 protected:
  WithdrawalGuardTest() {
    input_.target = input_.needle = Eigen::Vector3d(0, 0, kHeight);
    input_.force = Eigen::Vector3d::Zero();
    config_.witness.measured = false;  // the controller acts on the sensor
  }
  void enable() {
    controller_ = InjectionController(config_);
    controller_.command("enable");
    step(0);
  }
  /// One step under a force (N) along the pipette.
  void step(double force) {
    input_.force = force * kAxis;
    if (const auto setpoint = controller_.step(input_, 1e-3)) input_.needle = setpoint;
  }
  void press(double depth) { input_.target->z() -= depth; }
  double height() const { return input_.needle->z(); }
  bool saysOf(const std::string& text) const { return controller_.holdReason().find(text) != std::string::npos; }

  static constexpr double kHeight = 60e-6;  // m
  InjectionControllerConfig config_;
  InjectionController controller_{config_};
  InjectionController::Input input_;
  std::mt19937 random_{5};
};

TEST_F(WithdrawalGuardTest, AHandAndAForceThatTrembleMoveNothing) {
  enable();
  std::normal_distribution<double> force(0, 0.7 * config_.guards.force_limit);
  std::normal_distribution<double> hand(0, 0.2e-6);  // m, of the needle
  const Eigen::Vector3d rest = *input_.target;
  for (int i = 0; i < 60000; ++i) {
    *input_.target = rest + hand(random_) * kAxis;
    step(force(random_));
    ASSERT_NEAR(height(), kHeight, 3e-6) << "after " << i << " ms";
  }
}

TEST_F(WithdrawalGuardTest, ANeedleThatTremblesAboutItsSetPointIsNotPumped) {
  enable();
  std::normal_distribution<double> encoder(0, 0.1e-6);
  for (int i = 0; i < 60000; ++i) {
    input_.force = (i % 400 < 200 ? 1.1 : 0.1) * config_.guards.force_limit * kAxis;  // each time the limit ends again
    *input_.needle += encoder(random_) * kAxis;
    if (const auto setpoint = controller_.step(input_, 1e-3)) input_.needle = setpoint;
    ASSERT_NEAR(height(), kHeight, 3e-6) << "after " << i << " ms";
  }
}

TEST_F(WithdrawalGuardTest, AHandThatSwaysUnderALimitIsFollowedOutAndIsStoppedInTheEnd) {
  enable();
  for (int i = 0; controller_.state() == OperatingState::kEnabled && i < 100000; ++i) {
    press(i % 2000 < 1000 ? 20e-9 : -20e-9);  // 20 um down and up again
    step(2 * config_.guards.force_limit);
  }
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_NEAR(height(), kHeight + config_.guards.depth_limit, 0.1e-6);
  EXPECT_TRUE(saysOf("no force of the cell")) << controller_.holdReason();
  EXPECT_TRUE(saysOf("tare")) << controller_.holdReason();
  // Who has read it goes on, or home.
  EXPECT_EQ(controller_.command("resume"), "");
  step(0);
  press(-10e-6);
  for (int i = 0; i < 1000; ++i) step(0);
  EXPECT_GT(height(), kHeight + config_.guards.depth_limit + 5e-6);
  EXPECT_EQ(controller_.command("home"), "");
}

TEST_F(WithdrawalGuardTest, TheLimitEndsWhenTheForceHasBeenLowerForAWhile) {
  enable();
  const double limit = config_.guards.force_limit;
  step(1.01 * limit);
  EXPECT_TRUE(saysOf("only be withdrawn"));
  for (int i = 0; i < 1000; ++i) step(0.95 * limit);
  EXPECT_TRUE(saysOf("only be withdrawn")) << "just below";
  for (int i = 0; i < 90; ++i) step(0.5 * limit);
  EXPECT_TRUE(saysOf("only be withdrawn")) << "only just";
  for (int i = 0; i < 20; ++i) step(0.5 * limit);
  EXPECT_EQ(controller_.holdReason(), "");
  press(3e-6);
  for (int i = 0; i < 100; ++i) step(0);
  EXPECT_NEAR(height(), kHeight - 3e-6, 1e-9);
}

TEST_F(WithdrawalGuardTest, OfARefusedMotionOnlyThePlayIsOwed) {
  enable();
  const double limit = config_.guards.force_limit, play = 0.05 * config_.guards.depth_limit;
  step(1.1 * limit);
  press(40e-6);
  for (int i = 0; i < 10; ++i) step(1.1 * limit);
  EXPECT_NEAR(height(), kHeight, 1e-12);
  press(-(play + 5e-6));
  for (int i = 0; i < 100; ++i) step(1.1 * limit);
  EXPECT_NEAR(height(), kHeight + 5e-6, 1e-12);
}

TEST_F(WithdrawalGuardTest, AForceThatNoCellExertsIsAFaultOfTheSensor) {
  enable();
  press(5e-6);
  for (int i = 0; i < 100; ++i) step(0);
  const double before = height();
  press(10e-6);
  step(1000 * config_.guards.force_limit);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_TRUE(saysOf("1000 times")) << controller_.holdReason();
  EXPECT_TRUE(saysOf("mN for N?")) << controller_.holdReason();
  EXPECT_FALSE(saysOf("withdrawn")) << controller_.holdReason();
  for (int i = 0; i < 1000; ++i) step(1000 * config_.guards.force_limit);
  EXPECT_NEAR(height(), before, 1e-12);
  EXPECT_EQ(controller_.command("resume"), "");
  step(1000 * config_.guards.force_limit);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused) << "it is still there";
  EXPECT_EQ(controller_.command("home"), "");
  for (int i = 0; i < 5000; ++i) step(1000 * config_.guards.force_limit);
  EXPECT_NEAR(height(), kHeight, 2e-9) << "the way home is open";
}

TEST_F(WithdrawalGuardTest, AForceThatIsAThousandTimesThePredictedOneIsNamedAlreadyAtTheLimit) {
  enable();
  const double force = 1.2 * config_.guards.force_limit;
  input_.witness = force / 1000 * kAxis;
  step(force);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_TRUE(saysOf("1000 times the predicted")) << controller_.holdReason();
  EXPECT_TRUE(saysOf("mN for N?")) << controller_.holdReason();
  // A cell that is stiffer, or nearer, than its model is none.
  for (const double predicted : {force / 20, 0.0}) {
    enable();
    input_.witness = predicted * kAxis;
    step(force);
    EXPECT_EQ(controller_.state(), OperatingState::kEnabled) << predicted;
    EXPECT_TRUE(saysOf("only be withdrawn")) << controller_.holdReason();
  }
}

TEST_F(WithdrawalGuardTest, AForceThatIsFeltLongBeforeTheModelsTouchIsNoFaultOfTheSensor) {
  enable();
  std::normal_distribution<double> noise(0, 10e-9);  // N
  const double limit = config_.guards.force_limit, way = config_.witness.depth + 2e-6, steps = 300;
  for (int i = 0; i < config_.detection.noise_samples + 50; ++i) step(noise(random_));
  for (int i = 0; i < steps; ++i) {
    press(way / steps);
    step(0.9 * limit * i / steps + noise(random_));
  }
  input_.witness = limit / 1000 * kAxis;  // the model's cell begins here
  step(1.1 * limit);
  EXPECT_EQ(controller_.state(), OperatingState::kEnabled) << controller_.holdReason();
  EXPECT_TRUE(saysOf("only be withdrawn")) << controller_.holdReason();
}

TEST_F(WithdrawalGuardTest, DeepInTheCellToo) {
  enable();
  std::normal_distribution<double> noise(0, 10e-9);  // N
  const double limit = config_.guards.force_limit, way = config_.witness.depth + 5e-6, steps = 300;
  input_.witness = Eigen::Vector3d::Zero();
  for (int i = 0; i < config_.detection.noise_samples + 50; ++i) step(noise(random_));
  for (int i = 0; i < steps; ++i) {
    press(way / steps);
    input_.witness = 0.9e-3 * limit * i / steps * 20 * kAxis;
    step(0.9 * limit * i / steps + noise(random_));
  }
  input_.witness = 1.1 * limit / 1000 * kAxis;
  step(1.1 * limit);
  EXPECT_TRUE(saysOf("1000 times the predicted")) << controller_.holdReason();
}

TEST_F(WithdrawalGuardTest, AForceThatCannotBeStopsAnInjection) {
  config_.mode = "automatic";
  enable();
  for (int i = 0; i < 400; ++i) step(0);
  ASSERT_EQ(controller_.injection(), InjectionState::kApproach);
  const double before = height();
  step(20 * config_.guards.force_limit);
  EXPECT_EQ(controller_.result().outcome, InjectionOutcome::kGuard);
  EXPECT_NE(controller_.result().reason.find("20 times its limit"), std::string::npos) << controller_.result().reason;
  for (int i = 0; i < 100; ++i) step(20 * config_.guards.force_limit);
  EXPECT_NEAR(height(), before, 0.1e-6);
  EXPECT_EQ(controller_.command("withdraw"), "");
  for (int i = 0; i < 5000; ++i) step(20 * config_.guards.force_limit);
  EXPECT_NEAR(height(), kHeight, 2e-9);
}

}  // namespace
}  // namespace microinjection
