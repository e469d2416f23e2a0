#include "operation/control/injection_controller.h"

#include <gtest/gtest.h>

#include <limits>

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s
const Eigen::Vector3d kStart(0, 0, 60e-6);

class InjectionControllerTest : public testing::Test {
 protected:
  InjectionControllerTest() {
    input_.target = kStart;
    input_.needle = kStart;
    input_.force = Eigen::Vector3d::Zero();
  }

  /// The needle follows the set-point at once.
  std::optional<Eigen::Vector3d> run(int steps) {
    std::optional<Eigen::Vector3d> setpoint;
    for (int i = 0; i < steps; ++i) {
      setpoint = controller_.step(input_, kStep);
      if (setpoint && input_.needle) input_.needle = setpoint;
    }
    return setpoint;
  }

  InjectionControllerConfig config_;
  InjectionController controller_{config_};
  InjectionController::Input input_;
};

TEST_F(InjectionControllerTest, MovesNothingUntilItIsEnabled) {
  EXPECT_FALSE(run(5));
  EXPECT_EQ(controller_.command("enable"), "");
  EXPECT_EQ(*run(1), kStart);
  EXPECT_EQ(controller_.state(), OperatingState::kEnabled);
}

TEST_F(InjectionControllerTest, NamesTheForceThatItsGuardCompares) {
  EXPECT_EQ(controller_.guardForce(), 0);
  controller_.command("enable");
  input_.force = Eigen::Vector3d(1e-6, 0, 2e-6);
  run(1);
  EXPECT_EQ(controller_.guardForce(), 2e-6);
  input_.force.reset();
  run(1);
  EXPECT_EQ(controller_.guardForce(), 2e-6);
  controller_.command("disable");
  input_.force = Eigen::Vector3d(0, 0, 0.5e-6);
  run(1);
  EXPECT_EQ(controller_.guardForce(), 0.5e-6);
}

TEST_F(InjectionControllerTest, FollowsTheTargetWithinTheSpeedLimit) {
  controller_.command("enable");
  run(1);
  input_.target = Eigen::Vector3d(0, 0, 30e-6);
  EXPECT_NEAR(kStart.z() - run(1)->z(), config_.guards.speed_limit * kStep, 1e-15);
  EXPECT_LT((*run(1000) - *input_.target).norm(), 1e-15);
  EXPECT_TRUE(controller_.followsTarget());
}

TEST_F(InjectionControllerTest, DrivesALateRigSlowlyAndNeverFasterThanConfigured) {
  controller_.command("enable");
  run(1);
  input_.target = Eigen::Vector3d(0, 0, 30e-6);
  controller_.adaptTo(44e-6, 0);
  const double before = input_.needle->z();
  EXPECT_NEAR(before - run(1)->z(), 44e-6 * kStep, 1e-15);
  controller_.adaptTo(1, 1e-3);
  const double then = input_.needle->z();
  EXPECT_NEAR(then - run(1)->z(), config_.guards.speed_limit * kStep, 1e-15);
}

TEST_F(InjectionControllerTest, AbilitiesThatNoRigHasAreRefusedAndChangeNothing) {
  controller_.command("enable");
  run(1);
  input_.target = Eigen::Vector3d(0, 0, 30e-6);
  EXPECT_EQ(controller_.adaptTo(44e-6, 0), "");
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinite = std::numeric_limits<double>::infinity();
  for (const double speed : {kNan, kInfinite, -kInfinite, 0.0, -1.0, 1.1, 1e300})
    EXPECT_EQ(controller_.adaptTo(speed, 0).rfind("speed = ", 0), 0u) << speed;
  for (const double lag : {kNan, kInfinite, -1e-9, 11.0, 1e300})
    EXPECT_EQ(controller_.adaptTo(100e-6, lag).rfind("lag = ", 0), 0u) << lag;
  EXPECT_EQ(controller_.speedLimit(), 44e-6);
  const double before = input_.needle->z();
  EXPECT_NEAR(before - run(1)->z(), 44e-6 * kStep, 1e-15);
}

TEST_F(InjectionControllerTest, RefusesCommandsThatDoNotFitItsState) {
  EXPECT_NE(controller_.command("pause"), "");
  EXPECT_NE(controller_.command("resume"), "");
  EXPECT_NE(controller_.command("home"), "");
  EXPECT_NE(controller_.command("fly").find("\"fly\" is no command here; allowed: enable"), std::string::npos);
  EXPECT_EQ(controller_.state(), OperatingState::kDisabled);
  controller_.command("enable");
  EXPECT_NE(controller_.command("resume"), "");
  EXPECT_EQ(controller_.command("pause"), "");
  EXPECT_EQ(controller_.command("enable"), "state is PAUSED, enable is allowed in DISABLED, ENABLED, FAULT");
  EXPECT_EQ(controller_.command("pause"), "");
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_EQ(controller_.command("resume"), "");
  EXPECT_EQ(controller_.state(), OperatingState::kEnabled);
}

TEST_F(InjectionControllerTest, UnhomedItHoldsTheNeedleUntilItIsHome) {
  controller_.command("enable");
  input_.target = kStart;
  run(10);
  EXPECT_TRUE(controller_.homed());
  EXPECT_EQ(controller_.command("unhome"), "");
  EXPECT_FALSE(controller_.homed());
  EXPECT_EQ(controller_.state(), OperatingState::kEnabled);
  *input_.target += Eigen::Vector3d(0, 0, -5e-6);
  EXPECT_EQ(*run(100), kStart);
  EXPECT_EQ(controller_.holdReason(), "not homed; allowed after home");
  EXPECT_EQ(controller_.command("home"), "");
  run(10);
  EXPECT_TRUE(controller_.homed());
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_EQ(controller_.command("resume"), "");
  run(1);
  *input_.target += Eigen::Vector3d(0, 0, -5e-6);
  EXPECT_LT((*run(100) - kStart - Eigen::Vector3d(0, 0, -5e-6)).norm(), 1e-15);
}

TEST_F(InjectionControllerTest, HoldsWhilePaused) {
  controller_.command("enable");
  run(1);
  controller_.command("pause");
  input_.target = Eigen::Vector3d(0, 0, 50e-6);
  EXPECT_EQ(*run(100), kStart);
}

TEST_F(InjectionControllerTest, HoldsWithoutATrustedInput) {
  const Eigen::Vector3d nan = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  controller_.command("enable");
  run(1);
  const Eigen::Vector3d lower(0, 0, 50e-6);
  for (int which = 0; which < 6; ++which) {
    input_.target = lower;
    input_.needle = kStart;
    input_.force = Eigen::Vector3d::Zero();
    std::optional<Eigen::Vector3d>* inputs[] = {&input_.target, &input_.needle, &input_.force};
    if (which < 3) {
      inputs[which]->reset();
    } else {
      *inputs[which - 3] = nan;
    }
    EXPECT_EQ(*controller_.step(input_, kStep), kStart) << which;
    EXPECT_FALSE(controller_.holdReason().empty()) << which;
    EXPECT_EQ(controller_.state(), OperatingState::kEnabled) << which;
  }
}

TEST_F(InjectionControllerTest, TargetsCountFromWhereTheNeedleWasEnabledOrResumed) {
  controller_.command("enable");
  input_.target = kStart + Eigen::Vector3d(0, 0, 40e-6);
  EXPECT_EQ(*run(100), kStart);
  controller_.command("pause");
  *input_.target += Eigen::Vector3d(7e-6, 0, 0);
  run(10);
  controller_.command("resume");
  EXPECT_EQ(*run(100), kStart);
  *input_.target += Eigen::Vector3d(0, 0, -3e-6);
  EXPECT_LT((*run(100) - kStart - Eigen::Vector3d(0, 0, -3e-6)).norm(), 1e-15);
}

TEST_F(InjectionControllerTest, DoesNotFollowATargetThatLeaps) {
  controller_.command("enable");
  run(1);
  input_.target = kStart + Eigen::Vector3d(0, 0, 1.01 * config_.guards.jump_limit);
  EXPECT_EQ(*run(10), kStart);
  EXPECT_NE(controller_.holdReason().find("away, allowed"), std::string::npos);
}

TEST_F(InjectionControllerTest, PastTheForceLimitOnlyWithdraws) {
  controller_.command("enable");
  run(1);
  input_.force = Eigen::Vector3d(0, 0, 1.01 * config_.guards.force_limit);
  input_.target = kStart + Eigen::Vector3d(5e-6, 0, -5e-6);
  EXPECT_EQ(*run(100), kStart);
  input_.target = kStart + Eigen::Vector3d(5e-6, 0, 5e-6);
  // 10 um back from where the target was refused, less the play of WithdrawalGuard; what it did across is forgotten.
  EXPECT_LT((*run(100) - kStart - Eigen::Vector3d(0, 0, 10e-6 - 0.05 * config_.guards.depth_limit)).norm(), 1e-12);
}

TEST_F(InjectionControllerTest, NeedleThatDoesNotFollowIsAFaultUntilItIsEnabled) {
  controller_.command("enable");
  run(1);
  input_.needle = kStart + Eigen::Vector3d(1.01 * config_.guards.tracking_limit, 0, 0);
  EXPECT_FALSE(controller_.step(input_, kStep));
  EXPECT_EQ(controller_.state(), OperatingState::kFault);
  for (const char* command : {"home", "pause", "resume"}) EXPECT_NE(controller_.command(command), "") << command;
  EXPECT_FALSE(controller_.step(input_, kStep));
  EXPECT_EQ(controller_.command("enable"), "");
  EXPECT_EQ(controller_.injection(), InjectionState::kIdle);
  EXPECT_EQ(*controller_.step(input_, kStep), *input_.needle) << "takes hold where the needle is";
}

TEST_F(InjectionControllerTest, HomeWithdrawsAlongThePipetteFirstAlsoWithoutATrustedForce) {
  controller_.command("enable");
  run(1);
  input_.target = kStart + Eigen::Vector3d(5e-6, 0, -20e-6);
  run(1000);
  input_.force.reset();
  EXPECT_EQ(controller_.command("home"), "");
  EXPECT_TRUE(controller_.busy());
  while (controller_.busy()) {
    const Eigen::Vector3d before = *input_.needle;
    const Eigen::Vector3d step = *run(1) - before;
    if (before.z() < kStart.z() - 1e-9) ASSERT_EQ(step.head<2>().norm(), 0) << "sideways within the cell";
  }
  EXPECT_LT((*input_.needle - kStart).norm(), 1e-9);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
}

TEST_F(InjectionControllerTest, HomeNeverGoesDeeper) {
  controller_.command("enable");
  run(1);
  input_.target = kStart + Eigen::Vector3d(3e-6, 0, 20e-6);
  run(1000);
  controller_.command("home");
  run(1000);
  EXPECT_EQ(controller_.state(), OperatingState::kPaused);
  EXPECT_LT((*input_.needle - kStart - Eigen::Vector3d(0, 0, 20e-6)).norm(), 2e-9);
}

TEST_F(InjectionControllerTest, NeedleThatRunsAwayIsAFault) {
  controller_.command("enable");
  run(1);
  int steps = 0;
  while (controller_.state() == OperatingState::kEnabled && ++steps < 100) {
    *input_.needle += Eigen::Vector3d(0, 0, -1.1 * config_.guards.needle_speed_limit * kStep);
    controller_.step(input_, kStep);
  }
  EXPECT_EQ(controller_.state(), OperatingState::kFault);
  EXPECT_EQ(controller_.injection(), InjectionState::kFault);
  EXPECT_LE(steps, 25);
  EXPECT_NE(controller_.holdReason().find("m/s, allowed 0.001 m/s"), std::string::npos) << controller_.holdReason();
}

TEST_F(InjectionControllerTest, DoesNotCatchUpWithWhatTheForceLimitRefused) {
  controller_.command("enable");
  run(1);
  input_.force = Eigen::Vector3d(0, 0, 1.01 * config_.guards.force_limit);
  input_.target = kStart - Eigen::Vector3d(0, 0, 20e-6);
  run(100);
  input_.force = Eigen::Vector3d::Zero();  // a puncture
  EXPECT_LT((*run(1000) - kStart).norm(), 1e-12);
}

}  // namespace
}  // namespace microinjection
