#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

using ZaberTest = DriverTest<TestedZaber>;

TEST_F(ZaberTest, MovesToAPlaceInAStraightLine) {
  start();
  rig_->driver().moveTo(kPlace, 0.2e-3);
  const Eigen::Vector3d from = rig_->place(), way = (kPlace - from).normalized();
  double aside = 0, fastest = 0;
  Eigen::Vector3d last = from;
  rig_->run(1.5, [&] {
    const Eigen::Vector3d gone = rig_->place() - from;
    aside = std::max(aside, (gone - way * way.dot(gone)).norm());
    fastest = std::max(fastest, (rig_->place() - last).norm() / 1e-3);
    last = rig_->place();
  });
  EXPECT_FALSE(rig_->driver().moving());
  expectNear(rig_->place(), kPlace, kStep);
  EXPECT_NEAR(fastest, 0.2e-3, 0.02e-3);
  EXPECT_LT(aside, 4e-6);  // the axes begin one message (some 5 ms at 0.2 mm/s) after another
  EXPECT_EQ(rig_->device().movesBegun(), 3);
}

TEST_F(ZaberTest, FollowsSetPointsAndArrivesAtTheLast) {
  start();
  const Eigen::Vector3d velocity(0.2e-3, -0.1e-3, 0.05e-3);
  Eigen::Vector3d goal = rig_->place();
  double lag = 0, carried = 0;
  rig_->run(1.0, [&] {
    goal += velocity * 1e-3;
    rig_->driver().follow(goal, velocity);
    if (rig_->time() > 0.8) {
      lag = std::max(lag, (goal - rig_->place()).norm());
      carried = std::max(carried, (rig_->read() - rig_->place()).norm());
    }
  });
  EXPECT_LT(lag, velocity.norm() * rig_->driver().abilities().latency);
  EXPECT_LT(carried, 1e-6);
  rig_->driver().follow(goal, Eigen::Vector3d::Zero());
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->place(), goal, kStep);
  EXPECT_FALSE(rig_->device().moves());
}

TEST_F(ZaberTest, ASetPointThatIsNotRenewedIsReachedAndNotPassed) {
  start();
  const Eigen::Vector3d goal = rig_->place() + Eigen::Vector3d(20e-6, 0, 0);
  rig_->driver().follow(goal, Eigen::Vector3d(0.2e-3, 0, 0));
  rig_->run(3);
  expectNear(rig_->place(), goal, kStep);
}

TEST_F(ZaberTest, TheNewestCommandWins) {
  start();
  rig_->driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), 1e-3);
  rig_->run(0.3);
  EXPECT_TRUE(rig_->device().moves());
  moveAndCheck(kPlace);
  rig_->driver().follow(kPlace + Eigen::Vector3d(2e-3, 0, 0), Eigen::Vector3d::Zero());
  rig_->run(0.1);
  rig_->driver().follow(kPlace, Eigen::Vector3d::Zero());
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->place(), kPlace, kStep);
}

TEST_F(ZaberTest, AStopThatIsSaidAgainAndAgainLeavesItReadable) {
  start();
  rig_->driver().moveTo(kPlace, 1e-3);
  rig_->run(0.05);
  rig_->run(1, [&] { rig_->driver().stop(); });
  EXPECT_FALSE(rig_->device().moves());
  EXPECT_EQ(rig_->driver().state(), State::kReady);
  expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
}

TEST_F(ZaberTest, ThreeChainedDevicesWithChecksums) {
  ZaberEmulatorConfig device;
  device.devices = {1, 2, 3};
  device.axes = {1, 1, 1};
  device.checksum = true;
  ZaberConfig driver = TestedZaber::config();
  driver.reply_checksum = true;
  for (int i = 0; i < 3; ++i) driver.addresses[i] = {i + 1, 1};
  make(device, driver);
  start();
  moveAndCheck();
}

TEST_F(ZaberTest, RecoversFromFaultsOfTheLineAndLosesNoMove) {
  for (const bool follows : {false, true}) {  // a rig's node follows set-points only
    for (const char* fault :
         {"drop:1", "drop:30", "deaf:1", "garble:1", "error:AGAIN", "error:STATUSBUSY", "interrupt"}) {
      SCOPED_TRACE(std::string(fault) + (follows ? ", follows" : ", moves"));
      make();
      start();
      const auto command = [&] {
        if (follows) rig_->driver().follow(kPlace, Eigen::Vector3d::Zero());
        ASSERT_EQ(rig_->driver().state(), State::kReady) << rig_->driver().reason();
      };
      if (!follows) rig_->driver().moveTo(kPlace, 0.2e-3);
      rig_->run(0.05, command);
      rig_->inject(fault);
      rig_->run(1.5, command);
      ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().reason();
      expectNear(rig_->place(), kPlace, kStep);
      expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
    }
  }
}

TEST_F(ZaberTest, WhatItWasToldEndsWhenSeveralExchangesInARowFail) {
  for (const bool follows : {false, true}) {
    for (const char* fault : {"deaf:60", "garble:90", "silence:0.12", "silence:0.3"}) {
      SCOPED_TRACE(std::string(fault) + (follows ? ", follows" : ", moves"));
      make();
      start();
      const Eigen::Vector3d far = kPlace + Eigen::Vector3d(1e-3, 0, 0);
      if (!follows) rig_->driver().moveTo(far, 0.2e-3);
      rig_->run(0.06, [&] {
        if (follows) rig_->driver().follow(far, Eigen::Vector3d::Zero());
      });
      rig_->inject(fault);
      ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kDisconnected; }, 0.3));
      EXPECT_FALSE(rig_->driver().reading());
      ASSERT_TRUE(rig_->runUntilReady());
      rig_->run(0.5, [&] { EXPECT_FALSE(rig_->device().moves()); });
      EXPECT_LT(rig_->place().x(), 0.9e-3);
      expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
      rig_->run(3, [&] { rig_->driver().follow(kPlace, Eigen::Vector3d::Zero()); });
      expectNear(rig_->place(), kPlace, kStep);
    }
  }
}

TEST_F(ZaberTest, RefusalsAndFaultFlagsStopItAndSayWhy) {
  for (const auto& [fault, word] :
       {std::pair("error:BADDATA", "BADDATA"), {"error:PARKED", "PARKED"}, {"error:FS", "FS"}}) {
    SCOPED_TRACE(fault);
    make();
    start();
    rig_->driver().follow(kPlace, Eigen::Vector3d::Zero());
    rig_->run(0.02);
    rig_->inject(fault);
    ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 1));
    EXPECT_NE(rig_->driver().reason().find(word), std::string::npos) << rig_->driver().reason();
    rig_->run(0.3);
    EXPECT_FALSE(rig_->device().moves());
    rig_->driver().follow(kPlace, Eigen::Vector3d::Zero());  // not heard
    rig_->run(0.3);
    EXPECT_FALSE(rig_->device().moves());
    rig_->driver().clearFault();
    ASSERT_TRUE(rig_->runUntilReady());
    moveAndCheck();
  }
}

TEST_F(ZaberTest, MovesNothingWithoutAReferencePosition) {
  ZaberEmulatorConfig device;
  device.referenced = false;
  make(device);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 2));
  EXPECT_NE(rig_->driver().reason().find("home"), std::string::npos) << rig_->driver().reason();
  rig_->driver().clearFault();
  rig_->run(2);
  EXPECT_EQ(rig_->driver().state(), State::kFault);
  EXPECT_EQ(rig_->device().position(), ZaberEmulator(device).position());
}

TEST_F(ZaberTest, HomesWhenItsConfigurationSaysSo) {
  ZaberEmulatorConfig device;
  device.referenced = false;
  ZaberConfig driver = TestedZaber::config();
  driver.home = true;
  make(device, driver);
  ASSERT_TRUE(rig_->runUntilReady(30)) << rig_->driver().reason();
  expectNear(rig_->device().position(), Eigen::Vector3d::Zero(), kStep);
  expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
  rig_->run(1, [&] { ASSERT_EQ(rig_->driver().state(), ManipulatorDevice::State::kReady) << rig_->driver().reason(); });
}

TEST_F(ZaberTest, AStopThatTheLineLostIsSaidAgain) {
  start();
  const Eigen::Vector3d velocity(1e-3, 0, 0);
  Eigen::Vector3d goal = rig_->place();
  rig_->run(0.3, [&] { rig_->driver().follow(goal += velocity * 1e-3, velocity); });
  rig_->inject("deaf:39");  // the three stops
  const Eigen::Vector3d from = rig_->place();
  const double told = rig_->time();
  rig_->driver().stop();
  ASSERT_TRUE(rig_->runUntil([&] { return !rig_->device().moves(); }, 5));
  EXPECT_LT(rig_->time() - told, 0.15);
  EXPECT_LT((rig_->place() - from).norm(), 0.15e-3);
  ASSERT_TRUE(rig_->runUntilArrived());
  expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
}

TEST_F(ZaberTest, ADeviceThatWasSwitchedOffAndOnDoesNotHomeByItself) {
  ZaberConfig driver = TestedZaber::config();
  driver.home = true;
  make({}, driver);
  start();
  rig_->wire().disconnectCable();
  rig_->run(0.1);
  rig_->inject("error:WR");  // it has lost its reference position
  rig_->wire().connectCable();
  const Eigen::Vector3d there = rig_->place();
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
  EXPECT_NE(rig_->driver().reason().find("home"), std::string::npos) << rig_->driver().reason();
  rig_->run(1);
  expectNear(rig_->place(), there, 0);
}

TEST_F(ZaberTest, ItsEndIsToldAndNotHiddenByTryingForEver) {
  start();
  const Eigen::Vector3d outside = rig_->place() + Eigen::Vector3d(0, 0, 13e-3);
  rig_->driver().moveTo(outside, 2e-3);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 2));
  EXPECT_NE(rig_->driver().reason().find("BADDATA"), std::string::npos) << rig_->driver().reason();
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady());
  rig_->run(10, [&] { rig_->driver().follow(outside, Eigen::Vector3d::Zero()); });
  EXPECT_NE(rig_->driver().reason().find("end"), std::string::npos) << rig_->driver().reason();
}

TEST_F(ZaberTest, StopsWhenItIsDestroyed) {
  struct Ear : Wire {
    explicit Ear(std::string* heard) : heard_(heard) {}
    std::string open() override { return open_ = true, ""; }
    bool isOpen() const override { return open_; }
    std::string read(double) override { return *heard_ == "/\n" ? "@01 0 OK IDLE -- 0\r\n" : ""; }
    void write(const std::string& bytes, double) override { *heard_ = bytes; }
    std::string* heard_;
    bool open_ = false;
  };
  std::string heard;
  {
    ZaberDriver driver(TestedZaber::config(), std::make_unique<Ear>(&heard));
    for (double time = 0; heard.find("stop") == std::string::npos && time < 1;) driver.step(time += 1e-3);
    heard.clear();
  }
  EXPECT_EQ(heard, "/1 1 stop:98\n/1 2 stop:97\n/1 3 stop:96\n");
}

}  // namespace
}  // namespace microinjection
