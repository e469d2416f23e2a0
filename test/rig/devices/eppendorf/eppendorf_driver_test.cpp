#include "rig/devices/driver_fixture.h"
#include "rig/serial/emulated_line.h"

namespace microinjection {
namespace {

using EppendorfTest = DriverTest<TestedEppendorf>;

TEST_F(EppendorfTest, MovesToAPlaceAtItsSpeedInOneMoveAndReadsItUnderWay) {
  start();
  rig_->driver().moveTo(kPlace, 0.2e-3);
  const double way = (kPlace - rig_->place()).norm(), from = rig_->time();
  double off = 0;
  ASSERT_TRUE(rig_->runUntil(
      [&] {
        off = std::max(off, (rig_->read() - rig_->place()).norm());
        return rig_->time() > from + 0.1 && !rig_->driver().moving();
      },
      2));
  expectNear(rig_->place(), kPlace, 1e-9);
  EXPECT_EQ(rig_->device().movesBegun(), 1);
  EXPECT_GT(rig_->time() - from, 0.95 * way / 0.2e-3);
  EXPECT_LT(rig_->time() - from, 1.05 * way / 0.2e-3 + rig_->driver().abilities().latency + 0.02);
  EXPECT_LT(off, 6e-6);  // what it moves in an exchange, and rounding
}

TEST_F(EppendorfTest, NoGoToIsSaidWhileAnotherIsUnderWay) {
  start();  // the emulated one answers such a go-to with an error
  const Eigen::Vector3d velocity(0.1e-3, -0.05e-3, 0.02e-3);
  Eigen::Vector3d goal = rig_->place();
  rig_->run(2.0, [&] {
    goal += velocity * 1e-3;
    rig_->driver().follow(goal, velocity);
  });
  for (int i = 0; i < 20; ++i) {
    rig_->driver().moveTo(kPlace * (i % 2 == 0 ? 5 : -5), 1e-3);
    rig_->run(0.11 + 0.013 * i);
  }
  EXPECT_EQ(rig_->driver().malformed(), 0);
  EXPECT_EQ(rig_->driver().state(), State::kReady);
  moveAndCheck();
}

/// A wire whose line lives on when its driver is gone.
class LastingWire : public Wire {
 public:
  explicit LastingWire(EmulatedLine& line) : line_(line) {}
  std::string open() override { return ""; }
  bool isOpen() const override { return true; }
  std::string read(double time) override { return line_.receive(time); }
  void write(const std::string& bytes, double time) override { line_.send(bytes, time); }

 private:
  EmulatedLine& line_;
};

TEST_F(EppendorfTest, IsUnderRemoteControlAndGivesItBackAtRest) {
  const auto device = std::make_shared<EppendorfEmulator>();
  EmulatedLine line(device, 19200);
  double time = 0;  // s
  {
    EppendorfDriver driver(TestedEppendorf::config(), std::make_unique<LastingWire>(line));
    const auto run = [&](double duration) {
      for (const double end = time + duration; time < end;) driver.step(time += 1e-3);
    };
    run(2);
    ASSERT_EQ(driver.state(), State::kReady) << driver.why();
    EXPECT_TRUE(device->isRemote());
    driver.moveTo(kPlace, 0.1e-3);
    run(0.3);
    EXPECT_TRUE(device->moves());
  }
  line.receive(time + 0.1);
  EXPECT_FALSE(device->isRemote());
  EXPECT_FALSE(device->moves());
}

TEST_F(EppendorfTest, ReadsPositionsInTheFormsTheManualAllows) {
  for (const bool decimals : {false, true}) {
    EppendorfEmulatorConfig device;
    device.decimals = decimals;
    device.signs_separate = true;
    make(device);
    start();
    moveAndCheck();
    moveAndCheck(-kPlace);
  }
}

TEST_F(EppendorfTest, AnErrorIsToldAsItIsSaid) {
  start();
  for (int i = 0; i < 3; ++i) {
    rig_->inject("error:17");
    rig_->run(1.5);
  }
  ASSERT_EQ(rig_->driver().state(), State::kFault);
  EXPECT_NE(rig_->driver().why().find("ERR=017"), std::string::npos) << rig_->driver().why();
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady());
  moveAndCheck();
}

TEST_F(EppendorfTest, ALimitSwitchEndsAMoveByName) {
  EppendorfEmulatorConfig device;
  device.travel = 60e-6;
  make(device);
  start();
  rig_->driver().moveTo(kPlace, 1e-3);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 5));
  EXPECT_NE(rig_->driver().why().find("a limit switch is reached"), std::string::npos) << rig_->driver().why();
}

TEST_F(EppendorfTest, OneThatWasSwitchedOffIsNotBelieved) {
  start();
  moveAndCheck();
  rig_->wire().pull();
  rig_->run(0.2);
  rig_->device().shiftByHand(-rig_->device().position());  // its coordinates begin at 0
  rig_->wire().plug();
  rig_->run(5, [&] { EXPECT_FALSE(rig_->driver().reading()); });
  ASSERT_EQ(rig_->driver().state(), State::kFault);
  EXPECT_NE(rig_->driver().why().find("coordinates began anew"), std::string::npos) << rig_->driver().why();
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady());
  expectNear(rig_->read(), rig_->place(), TestedEppendorf::kTold);
}

TEST_F(EppendorfTest, RecoversFromFaultsOfTheLineAndLosesNoMove) {
  for (const char* fault : {"drop:1", "deaf:1", "deaf:4", "garble:1", "garble:3", "silence:0.1", "error:4",
                            "interrupt@0.9", "drop:1@0.9", "silence:0.5@0.9"}) {
    SCOPED_TRACE(fault);
    make();
    start();
    rig_->run(0.8 - rig_->time());
    rig_->inject(fault);
    rig_->driver().moveTo(kPlace, 0.2e-3);
    ASSERT_TRUE(rig_->runUntilArrived()) << rig_->driver().why();
    expectNear(rig_->place(), kPlace, kStep);
    EXPECT_LE(rig_->device().movesBegun(), 2);
  }
}

TEST_F(EppendorfTest, ASlowMachineMovesIt) {
  for (const double step : {0.03, 0.06, 0.12}) {
    SCOPED_TRACE(step);
    EmulatedRig<EppendorfDriver, EppendorfConfig> rig(TestedEppendorf::config(), std::make_shared<EppendorfEmulator>(),
                                                      step);
    ASSERT_TRUE(rig.runUntilReady(30)) << rig.driver().why();
    rig.driver().moveTo(kPlace, 1e-3);
    ASSERT_TRUE(rig.runUntilArrived(30)) << rig.driver().why();
    expectNear(rig.read(), kPlace, kStep);
  }
}

}  // namespace
}  // namespace microinjection
