// What CRTK asks of a manipulator beside its motion: is_busy, setpoint_cp, and a way to home.

#include <cmath>
#include <optional>

#include "hardware/manipulator/plain_rig.h"

namespace microinjection {
namespace {

class MicromanipulatorReports : public PlainRigTest {};

TEST_F(MicromanipulatorReports, IsBusyWithMovesOnly) {
  ASSERT_EQ(rig_.movePosition(at(1e-4, 0, 0)), "");
  EXPECT_TRUE(rig_.busy());
  run(0.02);
  EXPECT_TRUE(rig_.busy());
  run(1);
  EXPECT_FALSE(rig_.busy());
  EXPECT_NEAR(rig_.tipPose()->translation().x(), 1e-4, 1e-12);
  ASSERT_EQ(rig_.servoPosition(at(2e-4, 0, 0)), "");
  run(0.02);
  EXPECT_FALSE(rig_.busy());
  ASSERT_EQ(rig_.servoVelocity({1e-4, 0, 0}, time_), "");
  run(0.02);
  EXPECT_FALSE(rig_.busy());
}

TEST_F(MicromanipulatorReports, AStopOrAStreamEndsAMove) {
  ASSERT_EQ(rig_.movePosition(at(5e-4, 0, 0)), "");
  run(0.05);
  ASSERT_EQ(rig_.servoPosition(at(0, 0, 0)), "");
  EXPECT_FALSE(rig_.busy());
  run(1);
  ASSERT_EQ(rig_.movePosition(at(5e-4, 0, 0)), "");
  run(0.05);
  rig_.stop();
  run(0.2);
  EXPECT_FALSE(rig_.busy());
  EXPECT_LT(rig_.tipPose()->translation().x(), 4e-4);
}

TEST_F(MicromanipulatorReports, AMoveOfNoLengthIsAcceptedAndOver) {
  ASSERT_EQ(rig_.movePosition(at(0, 0, 0)), "");
  EXPECT_TRUE(rig_.busy());
  run(2 * kStep);
  EXPECT_FALSE(rig_.busy());
}

TEST_F(MicromanipulatorReports, TellsItsSetPoint) {
  run(kStep);
  ASSERT_TRUE(rig_.setpointPose());
  EXPECT_TRUE(rig_.setpointPose()->isApprox(*rig_.tipPose()));
  ASSERT_EQ(rig_.movePosition(at(3e-4, 0, 4e-4)), "");
  run(0.05);
  const Eigen::Vector3d under_way = rig_.setpointPose()->translation();
  EXPECT_GT(under_way.x(), 0);
  EXPECT_LT(under_way.x(), 3e-4);
  EXPECT_EQ(under_way, geometry().tip(rig_.setpoint()->position));
  run(1);
  EXPECT_LT((rig_.setpointPose()->translation() - Eigen::Vector3d(3e-4, 0, 4e-4)).norm(), 1e-12);
  ASSERT_EQ(rig_.servoVelocity({1e-4, 0, 0}, time_), "");
  run(kStep);
  EXPECT_FALSE(rig_.setpointPose());  // the convention: invalid while a velocity is commanded
}

/// A device whose axes look for their reference positions by themselves.
class HomingDevice : public SimulatedManipulator {
 public:
  using SimulatedManipulator::SimulatedManipulator;
  std::optional<Eigen::Vector3d> homingEnds() const override { return Eigen::Vector3d(0, 0, 2e-3); }
  void planHoming(const HomingPlan& plan) override { plan_ = plan; }
  std::optional<HomingPlan> plan_;
};

TEST_F(MicromanipulatorReports, TellsADeviceThatHomesHowItMay) {
  HomingDevice device{geometry(), device_config_};
  const Micromanipulator rig{geometry(), CollisionGuard(), MicromanipulatorConfig(), device};
  ASSERT_TRUE(device.plan_);
  EXPECT_NE(device.plan_->refusal.find("allowed"), std::string::npos) << device.plan_->refusal;  // travel ends at 1 mm
}

}  // namespace
}  // namespace microinjection
