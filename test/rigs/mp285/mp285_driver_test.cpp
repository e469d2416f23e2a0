#include "rigs/driver_fixture.h"

namespace microinjection {
namespace {

using Mp285Test = DriverTest<TestedMp285>;

TEST_F(Mp285Test, MovesToAPlaceAtItsSpeedInOneMove) {
  start();
  rig_->driver().moveTo(kPlace, 0.2e-3);
  const double way = (kPlace - rig_->place()).norm(), from = rig_->time();
  double carried = 0;
  ASSERT_TRUE(rig_->runUntil(
      [&] {
        carried = std::max(carried, (rig_->read() - rig_->place()).norm());
        return rig_->time() > from + 0.1 && !rig_->driver().moving();
      },
      2));
  expectNear(rig_->place(), kPlace, kStep);
  EXPECT_EQ(rig_->device().movesBegun(), 1);
  EXPECT_GT(rig_->time() - from, way / 0.2e-3);
  EXPECT_LT(rig_->time() - from, way / 0.2e-3 + rig_->driver().abilities().latency + 0.02);
  EXPECT_LT(carried, 2e-6);  // a move of 0.2 mm/s whose begin is known to some ms
  EXPECT_EQ(rig_->driver().largestCorrection(), 0);
}

TEST_F(Mp285Test, TakesSetPointsAsShortMovesTheNewestWins) {
  start();
  const Eigen::Vector3d velocity(0.1e-3, -0.05e-3, 0.02e-3);
  Eigen::Vector3d goal = rig_->place();
  double lag = 0;
  rig_->run(2.0, [&] {
    goal += velocity * 1e-3;
    rig_->driver().follow(goal, velocity);
    if (rig_->time() > 1) lag = std::max(lag, (goal - rig_->place()).norm());
  });
  const ManipulatorAbilities abilities = rig_->driver().abilities();
  EXPECT_LT(lag, velocity.norm() * (abilities.latency + abilities.command_interval));
  rig_->driver().follow(goal, Eigen::Vector3d::Zero());
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->place(), goal, kStep);
  const int moves = rig_->device().movesBegun();
  EXPECT_GT(moves, 2.0 / abilities.command_interval / 2);
  EXPECT_LT(moves, 2.0 / abilities.command_interval * 1.6);
  rig_->run(1);
  EXPECT_EQ(rig_->device().movesBegun(), moves);  // nothing is done twice
}

TEST_F(Mp285Test, ANewCommandBreaksOffALongMove) {
  start();
  rig_->driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), 1e-3);
  rig_->run(0.3);
  ASSERT_TRUE(rig_->device().moves());
  const double far = rig_->place().x();
  moveAndCheck(kPlace);
  EXPECT_LT(far, 1e-3);
  EXPECT_EQ(rig_->device().movesBegun(), 2);
}

TEST_F(Mp285Test, FastMovesAreCoarseAndEndFine) {
  auto fast = TestedMp285::config();
  fast.speed = 3e-3;
  rig_ = std::make_unique<Rig>(fast, std::make_shared<Mp285Emulator>());
  start();
  const Eigen::Vector3d place(3e-3 + 0.04e-6, 0.12e-6, -1e-3 + 0.08e-6);
  rig_->driver().moveTo(place, 3e-3);
  double fastest = 0;
  Eigen::Vector3d last = rig_->place();
  rig_->run(3, [&] {
    fastest = std::max(fastest, (rig_->place() - last).norm() / 1e-3);
    last = rig_->place();
  });
  expectNear(rig_->place(), place, 0.51 * kStep);
  EXPECT_NEAR(fastest, 3e-3, 0.1e-3);
  EXPECT_EQ(rig_->device().movesBegun(), 2);
}

TEST_F(Mp285Test, ReadsTheMicrostepRatherThanAssumingIt) {
  Mp285EmulatorConfig device;
  device.step_div = 16;  // 0.0625 um
  make(device);
  start();
  rig_->driver().moveTo(kPlace, 0.5e-3);
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->place(), kPlace, 0.51 * 0.0625e-6);
  EXPECT_DOUBLE_EQ(rig_->driver().abilities().resolution, 0.0625e-6);
}

TEST_F(Mp285Test, RecoversFromFaultsOfTheLineAndLosesNoMove) {
  for (const bool locks_up : {false, true}) {
    for (const char* fault : {"drop:1", "deaf:1", "deaf:4", "garble:1", "garble:3", "silence:0.1", "error:0", "error:1",
                              "error:2", "error:4", "error:8", "interrupt@0.9", "drop:1@0.9", "silence:1@0.9"}) {
      for (const bool ascii : {false, true}) {
        SCOPED_TRACE(fault);
        Mp285EmulatorConfig device;
        device.locks_up = locks_up;
        device.ascii_errors = ascii;
        make(device);
        start();
        rig_->run(0.8 - rig_->time());
        rig_->inject(fault);
        rig_->driver().moveTo(kPlace, 0.2e-3);
        ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().why();
        expectNear(rig_->place(), kPlace, kStep);
        expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
        EXPECT_LE(rig_->device().movesBegun(), 2);
      }
    }
  }
}

TEST_F(Mp285Test, AMoveEndsWhenSeveralExchangesInARowFail) {
  for (const bool locks_up : {false, true}) {
    for (const char* fault : {"drop:4", "deaf:6", "silence:0.7"}) {
      SCOPED_TRACE(fault);
      Mp285EmulatorConfig device;
      device.locks_up = locks_up;
      make(device);
      start();
      rig_->run(0.8 - rig_->time());
      rig_->inject(fault);
      rig_->driver().moveTo(kPlace, 0.2e-3);
      ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kDisconnected; }, 3));
      EXPECT_FALSE(rig_->driver().reading());
      ASSERT_TRUE(rig_->runUntilReady());
      const int moves = rig_->device().movesBegun();
      rig_->run(2);
      EXPECT_EQ(rig_->device().movesBegun(), moves);
      expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
      moveAndCheck();
    }
  }
}

TEST_F(Mp285Test, AMoveWhoseEndWasNotHeardIsNotDoneAgain) {
  start();
  rig_->driver().moveTo(kPlace, 0.2e-3);
  rig_->run(0.2);
  rig_->inject("drop:1");
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->place(), kPlace, kStep);
  EXPECT_EQ(rig_->device().movesBegun(), 1);
}

TEST_F(Mp285Test, AMoveThatIsInterruptedTwiceIsAFault) {
  start();
  rig_->driver().moveTo(kPlace, 0.1e-3);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(rig_->runUntil([&] { return rig_->device().moves(); }, 1));
    rig_->run(0.1);
    rig_->inject("interrupt");
  }
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 2));
  EXPECT_NE(rig_->driver().why().find("interrupted"), std::string::npos) << rig_->driver().why();
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady());
  moveAndCheck();
}

TEST_F(Mp285Test, ASlowMachineMovesIt) {
  for (const double step : {0.03, 0.06, 0.12}) {
    SCOPED_TRACE(step);
    EmulatedRig<Mp285Driver, Mp285Config> rig(TestedMp285::config(), std::make_shared<Mp285Emulator>(), step);
    ASSERT_TRUE(rig.runUntilReady(30)) << rig.driver().why();
    rig.driver().moveTo(kPlace, 1e-3);
    ASSERT_TRUE(rig.runUntilArrived(30)) << rig.driver().why();
    expectNear(rig.read(), kPlace, kStep);
  }
}

}  // namespace
}  // namespace microinjection
