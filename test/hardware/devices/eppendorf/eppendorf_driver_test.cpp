#include "hardware/devices/driver_fixture.h"
#include "hardware/serial/emulated_line.h"

namespace microinjection {
namespace {

using EppendorfTest = DriverTest<TestedEppendorf>;

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

/// Also where the command that gives it back does not stop it: the stop comes first.
TEST_F(EppendorfTest, IsUnderRemoteControlAndGivesItBackAtRest) {
  EppendorfEmulatorConfig config;
  config.manual_stops = false;
  const auto device = std::make_shared<EppendorfEmulator>(config);
  EmulatedLine line(device, 19200);
  double time = 0;  // s
  {
    EppendorfDriver driver(TestedEppendorf::config(), std::make_unique<LastingWire>(line));
    const auto run = [&](double duration) {
      for (const double end = time + duration; time < end;) driver.step(time += 1e-3);
    };
    run(2);
    ASSERT_EQ(driver.state(), State::kReady) << driver.reason();
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
  EXPECT_NE(rig_->driver().reason().find("ERR=017"), std::string::npos) << rig_->driver().reason();
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
  EXPECT_NE(rig_->driver().reason().find("a limit switch is reached"), std::string::npos) << rig_->driver().reason();
}

}  // namespace
}  // namespace microinjection
