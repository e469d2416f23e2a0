#include "rig/devices/driver_fixture.h"

namespace microinjection {
namespace {

using ScientificaTest = DriverTest<TestedScientifica>;

ScientificaConfig oldCard() {
  ScientificaConfig config = TestedScientifica::config();
  config.version = 2;
  config.port.baud = 9600;
  return config;
}
ScientificaEmulatorConfig oldDevice() {
  ScientificaEmulatorConfig device;
  device.version = "2.13";
  return device;
}

TEST_F(ScientificaTest, MovesInOneMoveAndReadsItUnderWay) {
  start();
  for (const double speed : {0.2e-3, 1e-3}) {
    const Eigen::Vector3d goal = speed < 0.5e-3 ? kPlace : -3 * kPlace;
    const double way = (goal - rig_->place()).norm(), from = rig_->time();
    const int moves = rig_->device().movesBegun();
    double off = 0;
    rig_->driver().moveTo(goal, speed);
    ASSERT_TRUE(rig_->runUntil(
        [&] {
          off = std::max(off, (rig_->read() - rig_->place()).norm());
          return rig_->time() > from + 0.05 && !rig_->driver().moving();
        },
        3));
    expectNear(rig_->place(), goal, kStep);
    EXPECT_EQ(rig_->device().movesBegun(), moves + 1);
    EXPECT_GT(rig_->time() - from, way / speed);
    EXPECT_LT(rig_->time() - from, way / speed + speed / 0.03 + rig_->driver().abilities().latency);
    EXPECT_LT(off, 1e-6 + speed * 0.05);  // a ramp, and what it moves in an exchange
  }
}

TEST_F(ScientificaTest, ACardOfVersion2CountsTenths) {
  make(oldDevice(), oldCard());
  start();
  rig_->driver().moveTo(kPlace, 0.5e-3);
  ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().why();
  expectNear(rig_->place(), kPlace, 0.1e-6);
  EXPECT_DOUBLE_EQ(rig_->driver().abilities().resolution, 0.1e-6);
}

TEST_F(ScientificaTest, WhatIsSlowerThanTheCardGoesInSteps) {
  make(oldDevice(), oldCard());
  start();
  const double from = rig_->time(), way = (kPlace - rig_->place()).norm(), speed = 20e-6;
  const Eigen::Vector3d start = rig_->place();
  double ahead = 0;
  rig_->driver().moveTo(kPlace, speed);
  ASSERT_TRUE(rig_->runUntil(
      [&] {
        ahead = std::max(ahead, (rig_->place() - start).norm() - speed * (rig_->time() - from));
        return rig_->time() > from + 1 && !rig_->driver().moving();
      },
      20));
  expectNear(rig_->place(), kPlace, 0.1e-6);
  EXPECT_LT(ahead, speed * 0.05 + 0.2e-6);  // a step
  EXPECT_GT(rig_->time() - from, 0.95 * way / speed);
  EXPECT_LT(rig_->time() - from, 2.5 * way / speed);
}

struct Refusal {
  ScientificaEmulatorConfig device;
  std::string why;
};

TEST_F(ScientificaTest, ACardWithOtherUnitsIsRefusedWithItsAnswerAndMovesNothing) {
  ScientificaEmulatorConfig maker, version, future, scale;
  maker.maker = "X1";
  version.version = "2.13";
  future.version = "4.01";
  scale.scale = 2540;
  for (const Refusal& each : {Refusal{maker, "answers \"X1\" to \"SCIENTIFICA\": no card of Scientifica's"},
                              {version, "answers \"2.13\" to \"VER\": the file has version 3"},
                              {future, "answers \"4.01\" to \"VER\": the file has version 3"},
                              {scale, "answers \"2540.00\" to \"USTEP X\": its positions have another unit"}}) {
    SCOPED_TRACE(each.why);
    make(each.device);
    rig_->run(6, [&] {
      rig_->driver().moveTo(kPlace, 1e-3);
      EXPECT_FALSE(rig_->driver().reading());
    });
    EXPECT_EQ(rig_->driver().state(), State::kFault);
    EXPECT_NE(rig_->driver().why().find(each.why), std::string::npos) << rig_->driver().why();
    EXPECT_EQ(rig_->device().movesBegun(), 0);
  }
}

TEST_F(ScientificaTest, NoGoToIsSaidWhileAnotherIsUnderWay) {
  start();  // the emulated one does not answer such a go-to
  const Eigen::Vector3d velocity(0.1e-3, -0.05e-3, 0.02e-3);
  Eigen::Vector3d goal = rig_->place();
  double lag = 0;
  rig_->run(2.0, [&] {
    goal += velocity * 1e-3;
    rig_->driver().follow(goal, velocity);
    if (rig_->time() > 1.5) lag = std::max(lag, (goal - rig_->place()).norm());
  });
  const ManipulatorAbilities abilities = rig_->driver().abilities();
  EXPECT_LT(lag, velocity.norm() * (abilities.latency + abilities.command_interval));
  for (int i = 0; i < 20; ++i) {
    rig_->driver().moveTo(kPlace * (i % 2 == 0 ? 5 : -5), 1e-3);
    rig_->run(0.11 + 0.013 * i);
  }
  EXPECT_EQ(rig_->driver().malformed(), 0);
  EXPECT_EQ(rig_->driver().state(), State::kReady);
  moveAndCheck();
}

TEST_F(ScientificaTest, RecoversFromFaultsOfTheLineAndLosesNoMove) {
  for (const char* fault : {"drop:1", "deaf:1", "deaf:4", "garble:1", "garble:3", "silence:0.1", "error:3",
                            "interrupt@0.9", "drop:1@0.9", "silence:0.5@0.9"}) {
    SCOPED_TRACE(fault);
    make();
    start();
    rig_->run(0.8 - rig_->time());
    rig_->inject(fault);
    rig_->driver().moveTo(kPlace, 0.2e-3);
    ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().why();
    expectNear(rig_->place(), kPlace, kStep);
    EXPECT_LE(rig_->device().movesBegun(), 3);
  }
}

TEST_F(ScientificaTest, AMoveThatIsInterruptedTwiceIsAFault) {
  start();
  rig_->driver().moveTo(kPlace, 0.1e-3);
  for (int i = 0; i < 2; ++i) {
    ASSERT_TRUE(rig_->runUntil([&] { return rig_->device().moves(); }, 1));
    rig_->run(0.1);
    rig_->inject("interrupt");
    rig_->run(2e-3);
  }
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 2));
  EXPECT_NE(rig_->driver().why().find("interrupted"), std::string::npos) << rig_->driver().why();
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady());
  moveAndCheck();
}

}  // namespace
}  // namespace microinjection
