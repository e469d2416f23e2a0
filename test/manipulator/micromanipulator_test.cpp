#include "manipulator/micromanipulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "manipulator/simulated_manipulator.h"

namespace microinjection {
namespace {

constexpr double kStep = 1e-3;  // s

ManipulatorGeometry geometry() {
  ManipulatorGeometry rig;
  for (auto& axis : rig.axes) axis = {"axis", -1e-3, 1e-3, 2e-3, 0.05};
  rig.directions.setIdentity();
  rig.tip_at_zero.setIdentity();
  return rig;
}

Eigen::Isometry3d at(double x, double y, double z) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << x, y, z;
  return pose;
}

class MicromanipulatorTest : public testing::Test {
 protected:
  void run(double duration) {
    const int steps = static_cast<int>(std::lround(duration / kStep));
    for (int i = 0; i < steps; ++i) {
      time_ += kStep;
      rig_.step(time_, kStep);
      fastest_ = std::max(fastest_, rig_.tipVelocity()->norm());
    }
  }

  SimulatedManipulatorConfig device_config_;
  SimulatedManipulator device_{geometry(), device_config_};
  Micromanipulator rig_{geometry(), CollisionGuard(), MicromanipulatorConfig(), device_};
  double time_ = 0;     // s
  double fastest_ = 0;  // m/s
};

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

}  // namespace
}  // namespace microinjection
