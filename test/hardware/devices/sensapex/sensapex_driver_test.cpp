#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

class SensapexTest : public DriverTest<TestedSensapex> {
 protected:
  SensapexEmulator& device() { return dynamic_cast<SensapexEmulator&>(rig_->device()); }
};

TEST_F(SensapexTest, AUmp4HoldsItsFourthAxis) {
  SensapexEmulatorConfig config;
  config.axes = 4;
  make(config);
  start();
  moveAndCheck();
}

TEST_F(SensapexTest, WhoMovesTheFourthAxisMakesPositionsInvalid) {
  SensapexEmulatorConfig config;
  config.axes = 4;
  make(config);
  start();
  device().shiftFourthAxis(20e-6);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 5));
  EXPECT_FALSE(rig_->driver().reading());
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady()) << rig_->driver().reason();
  moveAndCheck();
}

TEST_F(SensapexTest, OtherDevicesAreRefusedByTheirAxes) {
  SensapexEmulatorConfig config;
  config.axes = 1;
  make(config);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
  EXPECT_NE(rig_->driver().reason().find("three or four axes"), std::string::npos) << rig_->driver().reason();
}

TEST_F(SensapexTest, AnotherNumberInTheNetworkIsNotAnswered) {
  SensapexEmulatorConfig config;
  config.device = 2;
  make(config);
  rig_->run(5);
  EXPECT_NE(rig_->driver().state(), State::kReady);
}

/// Positions that tremble at rest are no motion by hand.
TEST_F(SensapexTest, ATremblingPositionIsKept) {
  SensapexEmulatorConfig config;
  config.jitter = 15e-9;
  make(config);
  start();
  moveAndCheck();
  const Eigen::Vector3d told = rig_->read();
  rig_->run(5, [&] { EXPECT_EQ(rig_->read(), told); });
}

TEST_F(SensapexTest, ASlowMoveHasItsSpeed) {
  start();
  const Eigen::Vector3d from = rig_->place(), way(2e-6, 1e-6, 0);
  const double begin = rig_->time(), speed = 0.4e-6;
  rig_->driver().moveTo(from + way, speed);
  ASSERT_TRUE(rig_->runUntilArrived(20)) << rig_->driver().reason();
  expectNear(rig_->place(), from + way, 1e-9);
  EXPECT_GT(rig_->time() - begin, 0.99 * way.norm() / speed);
  EXPECT_LT(rig_->time() - begin, 1.1 * way.norm() / speed + 0.3);
}

}  // namespace
}  // namespace microinjection
