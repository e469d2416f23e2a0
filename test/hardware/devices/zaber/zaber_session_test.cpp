// What the driver asks of the devices before anything moves, and what it makes of it.

#include <algorithm>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

class ZaberSessionTest : public DriverTest<TestedZaber> {
 protected:
  void makeWith(double of_device, double of_file, double held = 0) {
    ZaberEmulatorConfig device;
    device.acceleration = of_device;
    ZaberConfig driver = TestedZaber::config();
    driver.acceleration = of_file;
    rig_ = std::make_unique<Rig>(driver, std::make_shared<ZaberEmulator>(device), 1e-3, held);
  }
  void tell(const std::string& command) { rig_->device().receive("/" + command + "\n", rig_->time()); }
  /// A ramp at `velocity` (m/s); returns the farthest (m) behind it after the first half second.
  double farthestBehind(const Eigen::Vector3d& velocity, double duration) {
    Eigen::Vector3d goal = rig_->place();
    double behind = 0, time = 0;
    rig_->run(duration, [&] {
      goal += velocity * 1e-3;
      rig_->driver().follow(goal, velocity);
      if ((time += 1e-3) > 0.5) behind = std::max(behind, (goal - rig_->place()).norm());
    });
    goal_ = goal;
    return behind;
  }
  Eigen::Vector3d goal_ = Eigen::Vector3d::Zero();  // m
};

TEST_F(ZaberSessionTest, RefusesADeviceWhoseAccelerationIsNotTheFiles) {
  for (const auto& [of_device, of_file] : {std::pair(0.02, 0.2), {0.2, 0.02}, {0.2, 0.23}, {0.2, 0.175}}) {
    SCOPED_TRACE(of_device);
    makeWith(of_device, of_file);
    ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
    const std::string why = rig_->driver().reason();
    for (const char* word : {"axis 1 of device 1", "acceleration", "within a tenth", "get accel"}) {
      EXPECT_NE(why.find(word), std::string::npos) << why;
    }
    const Eigen::Vector3d there = rig_->place();
    rig_->run(2, [&] { rig_->driver().follow(kPlace, Eigen::Vector3d::Zero()); });
    expectNear(rig_->place(), there, 0);
  }
}

TEST_F(ZaberSessionTest, AnAccelerationThatWasSetRightIsReadWhenTheFaultIsCleared) {
  makeWith(0.02, 0.2);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
  tell("1 0 set accel 688");  // 0.2 m/s^2
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady());
  moveAndCheck();
}

TEST_F(ZaberSessionTest, TheWeakerOfAccelerationAndBrakingCounts) {
  makeWith(0.2, 0.2);
  tell("1 2 set motion.decelonly 100");  // 0.03 m/s^2
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
  EXPECT_NE(rig_->driver().reason().find("axis 2 of device 1"), std::string::npos) << rig_->driver().reason();
  EXPECT_NE(rig_->driver().reason().find("motion.decelonly"), std::string::npos) << rig_->driver().reason();
}

TEST_F(ZaberSessionTest, StopsInTheTimeThatTheDevicesOwnAccelerationGives) {
  makeWith(0.185, 0.2);
  start();
  const double wire = 40 * 10.0 / 115200;  // s, of three stops
  const ManipulatorAbilities abilities = rig_->driver().abilities();
  const double answer = abilities.latency / 4 - (kZaberCommandBytes + kZaberReplyBytes) * 10.0 / 115200;  // s
  EXPECT_NEAR(abilities.stop_time, 2e-3 / 0.185 + wire + answer, 0.3e-3);
}

TEST_F(ZaberSessionTest, RefusesADeviceThatCountsOtherMicrosteps) {
  make();
  tell("1 3 set resolution 128");
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
  EXPECT_NE(rig_->driver().reason().find("128 microsteps a full step"), std::string::npos) << rig_->driver().reason();
  rig_->run(2, [&] { EXPECT_FALSE(rig_->driver().reading()); });
}

TEST_F(ZaberSessionTest, AsksOnceMoreForLessWhereADeviceLacksASetting) {
  ZaberEmulatorConfig device;
  device.without = {"motion.decelonly", "resolution"};
  make(device);
  start();
  moveAndCheck();
}

TEST_F(ZaberSessionTest, ADeviceThatHasNoSuchAxisIsRefused) {
  ZaberConfig driver = TestedZaber::config();
  driver.addresses[2].axis = 4;
  make({}, driver);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3));
  EXPECT_NE(rig_->driver().reason().find("axis 4 of device 1"), std::string::npos) << rig_->driver().reason();
  EXPECT_NE(rig_->driver().reason().find("BADAXIS"), std::string::npos) << rig_->driver().reason();
}

TEST_F(ZaberSessionTest, SaysThatRepliesComeWithoutChecksums) {
  ZaberConfig driver = TestedZaber::config();
  driver.reply_checksum = true;
  make({}, driver);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 5));
  EXPECT_NE(rig_->driver().reason().find("comm.checksum"), std::string::npos) << rig_->driver().reason();
}

// A line that holds each answer back, as a USB adapter with its latency timer does.

TEST_F(ZaberSessionTest, ReadingsAreAsOftenAsItSaysAlsoOnASlowLine) {
  for (const double held : {0.0, 17e-3, 40e-3, 70e-3}) {  // s
    SCOPED_TRACE(held);
    makeWith(0.2, 0.2, held);
    ASSERT_TRUE(rig_->runUntilReady(20)) << rig_->driver().reason();
    const ManipulatorAbilities abilities = rig_->driver().abilities();
    EXPECT_EQ(abilities.device.find("answers take") != std::string::npos, held > 0) << abilities.device;
    EXPECT_GT(abilities.reading_interval, 6 * held);
    EXPECT_LT(abilities.reading_interval, 6 * held + 0.06);
    // Each true reading shows that the device was shifted by hand, by less than a damaged one would be.
    double seen = 0;  // s, until a shift is told
    for (int i = 0; i < 5; ++i) {
      rig_->device().shiftByHand(2 * Eigen::Vector3d::Constant(kStep));
      const double from = rig_->time();
      ASSERT_TRUE(rig_->runUntil([&] { return (rig_->read() - rig_->place()).norm() < 1e-9; }, 3));
      seen = std::max(seen, rig_->time() - from);
      rig_->run(0.0137);
    }
    EXPECT_LE(seen, abilities.reading_interval + held + 0.01);
  }
}

TEST_F(ZaberSessionTest, FollowsOnASlowLineWithoutAheadOrFault) {
  for (const double held : {17e-3, 40e-3}) {      // s
    for (const double speed : {20e-6, 200e-6}) {  // m/s
      SCOPED_TRACE(std::to_string(held) + " s, m/s: " + std::to_string(speed));
      makeWith(0.2, 0.2, held);
      ASSERT_TRUE(rig_->runUntilReady(20)) << rig_->driver().reason();
      const ManipulatorAbilities abilities = rig_->driver().abilities();
      const double behind = farthestBehind({speed, 0, 0}, 3);
      EXPECT_LE(behind, speed * (2 * abilities.command_interval + abilities.reading_interval + abilities.latency));
      EXPECT_EQ(rig_->driver().state(), State::kReady) << rig_->driver().reason();
      double past = 0;
      rig_->driver().follow(goal_, Eigen::Vector3d::Zero());
      rig_->run(1, [&] { past = std::max(past, (rig_->place() - goal_).x()); });
      ASSERT_TRUE(rig_->runUntilArrived(20));
      EXPECT_LE(past, speed * (abilities.latency + abilities.command_interval) + kStep);
      expectNear(rig_->place(), goal_, kStep);
      expectNear(rig_->read(), rig_->place(), 0.1 * kStep);
    }
  }
}

TEST_F(ZaberSessionTest, WhatIsCarriedOnIsTrueOnASlowLine) {
  makeWith(0.2, 0.2, 17e-3);
  ASSERT_TRUE(rig_->runUntilReady(20));
  const Eigen::Vector3d velocity(0.2e-3, 0, 0);
  Eigen::Vector3d goal = rig_->place();
  double off = 0;
  const double from = rig_->time() + 1;
  rig_->run(3, [&] {
    goal += velocity * 1e-3;
    rig_->driver().follow(goal, velocity);
    if (rig_->time() > from && rig_->driver().reading()) off = std::max(off, (rig_->read() - rig_->place()).norm());
  });
  EXPECT_LT(off, 1e-6);  // half of an answer's 18 ms would be 1.8 um
}

TEST_F(ZaberSessionTest, AMotionDoesNotEndBetweenTwoTurnsOfASlowLine) {
  makeWith(0.2, 0.2, 40e-3);
  ASSERT_TRUE(rig_->runUntilReady(20));
  const Eigen::Vector3d velocity(0.2e-3, 0, 0);
  Eigen::Vector3d goal = rig_->place(), last = goal;
  int stood = 0;
  const double from = rig_->time() + 1;
  rig_->run(4, [&] {
    goal += velocity * 1e-3;
    rig_->driver().follow(goal, velocity);
    if (rig_->time() > from && rig_->place() == last) ++stood;
    last = rig_->place();
  });
  EXPECT_EQ(stood, 0);
}

// Three devices chained on the line, each with an axis; they send alerts and info lines.

TEST_F(ZaberSessionTest, AChainThatSendsAlertsAndInfoLinesWorksAsOneDevice) {
  ZaberEmulatorConfig device;
  device.devices = {1, 2, 3};
  device.axes = {1, 1, 1};
  device.alerts = true;
  device.info_every = 3;
  ZaberConfig driver = TestedZaber::config();
  for (int i = 0; i < 3; ++i) driver.addresses[i] = {i + 1, 1};
  for (const bool numbers : {true, false}) {
    SCOPED_TRACE(numbers ? "with numbers" : "without numbers");
    driver.numbers = numbers;
    make(device, driver);
    start();
    for (int i = 0; i < 5; ++i) {
      moveAndCheck(kPlace);
      farthestBehind({50e-6, -50e-6, 0}, 1);
      rig_->driver().follow(goal_, Eigen::Vector3d::Zero());
      ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().reason();
      expectNear(rig_->place(), goal_, kStep);
    }
    EXPECT_EQ(rig_->driver().malformed(), 0);
    rig_->driver().stop();
    rig_->run(0.3);
    EXPECT_EQ(rig_->driver().state(), State::kReady) << rig_->driver().reason();
  }
}

}  // namespace
}  // namespace microinjection
