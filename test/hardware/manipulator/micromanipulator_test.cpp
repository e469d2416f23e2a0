#include <cmath>
#include <limits>

#include "hardware/manipulator/plain_rig.h"

namespace microinjection {
namespace {

class MicromanipulatorTest : public PlainRigTest {};

TEST_F(MicromanipulatorTest, ServoFollowsWithTheStatedLag) {
  // A ramp of speed v is followed with the lag v tau once the start has died away.
  const double v = 1e-3;
  for (int i = 1; i <= 100; ++i) {
    ASSERT_EQ(rig_.servoPosition(at(0, 0, v * i * kStep)), "");
    run(kStep);
  }
  // Discrete lag of the exact first-order filter: v dt q / (1 - q) with q = exp(-dt / tau).
  const double q = std::exp(-kStep / device_config_.servo_time_constant);
  EXPECT_NEAR(v * 100 * kStep - rig_.tipPose()->translation().z(), v * kStep * q / (1 - q), 1e-9);
}

TEST_F(MicromanipulatorTest, NeverFasterThanItsAxes) {
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(rig_.servoPosition(at(0, 0, 0.9e-3)), "");
    run(kStep);
  }
  EXPECT_LE(fastest_, 2e-3 * 1.0001);
  EXPECT_GT(fastest_, 1.9e-3);
  EXPECT_NEAR(rig_.tipPose()->translation().z(), 0.9e-3, 1e-12);
}

TEST_F(MicromanipulatorTest, MoveArrivesWithinItsAcceleration) {
  ASSERT_EQ(rig_.movePosition(at(3e-4, 0, 4e-4)), "");
  EXPECT_TRUE(rig_.moving());
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  double steepest = 0;
  for (int i = 0; i < 2000; ++i) {
    run(kStep);
    steepest = std::max(steepest, (*rig_.tipVelocity() - before).cwiseAbs().maxCoeff() / kStep);
    before = *rig_.tipVelocity();
  }
  EXPECT_FALSE(rig_.moving());
  EXPECT_LT((rig_.tipPose()->translation() - Eigen::Vector3d(3e-4, 0, 4e-4)).norm(), 1e-12);
  EXPECT_LT(steepest, 1.0001 * geometry().axes[0].acceleration);
}

TEST_F(MicromanipulatorTest, StaleVelocityCommandStops) {
  ASSERT_EQ(rig_.servoVelocity({1e-4, 0, 0}, time_), "");
  run(0.09);
  EXPECT_NEAR(rig_.tipVelocity()->x(), 1e-4, 1e-7);
  run(0.2);
  EXPECT_NEAR(rig_.tipVelocity()->norm(), 0, 1e-9);
  EXPECT_FALSE(rig_.moving());
  const double held = rig_.tipPose()->translation().x();
  run(0.5);
  EXPECT_DOUBLE_EQ(rig_.tipPose()->translation().x(), held);
}

TEST_F(MicromanipulatorTest, RefusalLeavesTheNeedleWhereItWas) {
  ASSERT_EQ(rig_.servoPosition(at(1e-4, 0, 0)), "");
  run(0.5);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(rig_.servoPosition(at(nan, 0, 0)), "");
  EXPECT_NE(rig_.movePosition(at(2e-3, 0, 0)), "");
  EXPECT_NE(rig_.servoVelocity({3e-3, 0, 0}, time_), "");
  EXPECT_NE(rig_.servoVelocity({nan, 0, 0}, time_), "");
  Eigen::Isometry3d turned = at(0, 0, 0);
  turned.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_NE(rig_.servoPosition(turned).find("orientation"), std::string::npos);
  run(0.5);
  EXPECT_NEAR(rig_.tipPose()->translation().x(), 1e-4, 1e-12);
}

TEST_F(MicromanipulatorTest, VelocityCommandStopsBeforeTheTravelAndSaysSo) {
  std::string refusal;
  for (int i = 0; i < 1500; ++i) {
    refusal = rig_.servoVelocity({0, 1e-3, 0}, time_);
    run(kStep);
  }
  EXPECT_NE(refusal.find("axis = 0.001"), std::string::npos) << refusal;
  EXPECT_FALSE(rig_.moving());
  const double y = rig_.tipPose()->translation().y();
  EXPECT_LE(y, 1e-3);
  EXPECT_GT(y, 1e-3 - 2e-3 * kStep - 1e-3 * 1e-3 / (2 * 0.05));  // its braking distance and a step or two
}

TEST_F(MicromanipulatorTest, AnAdmissibleStreamIsFollowedExactly) {
  // A ramp up, cruise, reversal and rest, all within 0.05 m/s^2 and 2 mm/s.
  double z = 0, v = 0;
  for (int i = 0; i < 400; ++i) {
    const double wanted = i < 100 ? 0.4e-3 : i < 250 ? -0.5e-3 : 0;
    v += std::clamp(wanted - v, -0.05 * kStep, 0.05 * kStep);
    z += v * kStep;
    ASSERT_EQ(rig_.servoPosition(at(z / 2, 0, z)), "");
    run(kStep);
    ASSERT_NEAR(rig_.setpoint()->position.z(), z, 1e-15);
    ASSERT_NEAR(rig_.setpoint()->position.x(), z / 2, 1e-15);
  }
}

TEST_F(MicromanipulatorTest, AJumpIsFollowedWithinSpeedAndAccelerationAndWithoutOvershoot) {
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(rig_.servoPosition(at(4e-4, -2e-4, 0)), "");
    run(kStep);
    const AxesMotion& now = *rig_.setpoint();
    EXPECT_LE((now.velocity - before).cwiseAbs().maxCoeff(), 0.05 * kStep * 1.000001);
    EXPECT_LE(now.velocity.cwiseAbs().maxCoeff(), 2e-3);
    EXPECT_LE(now.position.x(), 4e-4 + 1e-12);
    before = now.velocity;
  }
  EXPECT_LT((rig_.setpoint()->position - Eigen::Vector3d(4e-4, -2e-4, 0)).norm(), 1e-12);
}

TEST_F(MicromanipulatorTest, AStaleServoStreamStopsTheDevice) {
  ASSERT_EQ(rig_.servoPosition(at(0, 0, 0.9e-3)), "");
  run(0.09);
  EXPECT_GT(rig_.tipVelocity()->norm(), 1.9e-3);
  run(0.1);  // 0.1 s of time-out; braking takes 40 ms, the lag dies away
  EXPECT_LT(rig_.tipVelocity()->norm(), 1e-5);
  EXPECT_EQ(rig_.abortReason(), "servo_cp is stale");
  EXPECT_FALSE(rig_.setpoint());
  run(0.1);
  const double held = rig_.tipPose()->translation().z();
  EXPECT_LT(held, 0.3e-3);
  run(1);
  EXPECT_NEAR(rig_.tipPose()->translation().z(), held, 1e-12);
}

TEST_F(MicromanipulatorTest, AStreamThatRestsMayPause) {
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(rig_.servoPosition(at(1e-5, 0, 0)), "");
    run(kStep);
  }
  run(1);
  EXPECT_EQ(rig_.abortReason(), "");
  EXPECT_NEAR(rig_.tipPose()->translation().x(), 1e-5, 1e-12);
}

TEST_F(MicromanipulatorTest, AfterAStopItStartsFromWhereItIs) {
  ASSERT_EQ(rig_.movePosition(at(0.8e-3, 0, 0)), "");
  run(0.2);
  rig_.stop();
  EXPECT_FALSE(rig_.moving());
  run(0.2);
  const Eigen::Vector3d rested = rig_.tipPose()->translation();
  EXPECT_LT(rested.x(), 0.5e-3);
  ASSERT_EQ(rig_.servoVelocity({0, 0, 1e-4}, time_), "");
  EXPECT_LT((rig_.setpoint()->position - rested).norm(), 1e-15);
  run(0.05);
  EXPECT_NEAR(rig_.tipPose()->translation().x(), rested.x(), 1e-9);
  EXPECT_GT(rig_.tipPose()->translation().z(), 1e-6);
}

TEST_F(MicromanipulatorTest, AStreamThatGoesOnAfterAStopMovesNothingBeforeItHasPaused) {
  double x = 0;
  const auto stream = [&] { return rig_.servoPosition(at(x += 1e-7, 0, 0)); };
  const auto shouldContinue = [&](double duration) {
    for (const double end = time_ + duration; time_ < end; run(kStep)) stream();
  };
  shouldContinue(0.3);
  for (const bool enabled : {false, true}) {
    rig_.stop();
    run(0.06);
    const Eigen::Vector3d rested = rig_.tipPose()->translation();
    EXPECT_NE(stream().find("stopped"), std::string::npos);
    EXPECT_NE(rig_.servoVelocity({1e-4, 0, 0}, time_).find("stopped"), std::string::npos);
    shouldContinue(0.3);
    EXPECT_LT((rig_.tipPose()->translation() - rested).norm(), 1e-12);
    if (enabled) {
      rig_.clearFault();
    } else {
      run(0.15);
    }
    EXPECT_EQ(stream(), "");
    shouldContinue(0.3);
    EXPECT_NEAR(rig_.tipPose()->translation().x(), x, 1e-6);
  }
  rig_.stop();
  EXPECT_EQ(rig_.movePosition(at(0, 0, 0)), "");  // a command of its own
}

TEST_F(MicromanipulatorTest, AStreamThatOutlivesAFaultMovesNothingBeforeItHasPaused) {
  const auto stream = [&](double duration) {
    for (const double end = time_ + duration; time_ < end; run(kStep)) rig_.servoPosition(at(1e-4, 0, 0));
  };
  stream(0.02);
  device_.injectFault("motor is hot");
  stream(0.2);
  const Eigen::Vector3d held = rig_.tipPose()->translation();
  EXPECT_LT(held.x(), 0.9e-4);
  rig_.clearFault();
  stream(0.3);
  EXPECT_LT((rig_.tipPose()->translation() - held).norm(), 1e-12);
  run(0.15);
  stream(0.5);
  EXPECT_NEAR(rig_.tipPose()->translation().x(), 1e-4, 1e-9);
}

TEST_F(MicromanipulatorTest, AStreamThatWaitedAtTheNeedleGoesOnWhenTheFaultIsCleared) {
  const auto stream = [&](double duration, double ahead) {
    for (const double end = time_ + duration; time_ < end; run(kStep))
      rig_.servoPosition(at(rig_.tipPose()->translation().x() + ahead, 0, 0));
  };
  stream(0.02, 10e-6);
  device_.injectFault("motor is hot");
  stream(0.2, 0);
  EXPECT_NE(rig_.streamHold(), "");
  const double held = rig_.tipPose()->translation().x();
  rig_.clearFault();
  stream(0.01, 0);
  EXPECT_EQ(rig_.streamHold(), "");
  EXPECT_NEAR(rig_.tipPose()->translation().x(), held, 1e-9) << "nothing leaps";
  stream(0.3, 10e-6);
  EXPECT_GT(rig_.tipPose()->translation().x(), held + 20e-6);
  // Without enable, and after a stop, it does not.
  rig_.stop();
  stream(0.3, 0);
  EXPECT_NE(rig_.streamHold(), "");
}

TEST_F(MicromanipulatorTest, ANewGoalIsReachedInAStraightLineAfterTheTurn) {
  ASSERT_EQ(rig_.movePosition(at(0.8e-3, 0, 0)), "");
  run(0.2);
  ASSERT_EQ(rig_.movePosition(at(0, 0.5e-3, 0)), "");
  run(0.05);  // 2 mm/s are braked in 40 ms
  const Eigen::Vector3d turn = rig_.setpoint()->position;
  const Eigen::Vector3d line = (Eigen::Vector3d(0, 0.5e-3, 0) - turn).normalized();
  while (rig_.moving()) {
    run(kStep);
    EXPECT_LT((rig_.setpoint()->position - turn).cross(line).norm(), 1e-12);
  }
  EXPECT_EQ(rig_.setpoint()->position, Eigen::Vector3d(0, 0.5e-3, 0));
}

TEST_F(MicromanipulatorTest, AFaultStopsAndIsTheReasonOfRefusals) {
  ASSERT_EQ(rig_.movePosition(at(0.8e-3, 0, 0)), "");
  run(0.2);
  device_.injectFault("motor is hot");
  run(0.2);
  EXPECT_EQ(rig_.state(), ManipulatorDevice::State::kFault);
  EXPECT_FALSE(rig_.moving());
  EXPECT_EQ(rig_.movePosition(at(0, 0, 0)), "motor is hot");
  EXPECT_EQ(rig_.servoPosition(at(0, 0, 0)), "motor is hot");
  EXPECT_EQ(rig_.servoVelocity({1e-4, 0, 0}, time_), "motor is hot");
  const Eigen::Vector3d held = rig_.tipPose()->translation();
  run(0.1);
  rig_.clearFault();
  EXPECT_EQ(rig_.state(), ManipulatorDevice::State::kReady);
  run(0.5);
  EXPECT_LT((rig_.tipPose()->translation() - held).norm(), 1e-12) << "rests until the next command";
  ASSERT_EQ(rig_.movePosition(at(0, 0, 0)), "");
  run(2);
  EXPECT_LT(rig_.tipPose()->translation().norm(), 1e-12);
}

}  // namespace
}  // namespace microinjection
