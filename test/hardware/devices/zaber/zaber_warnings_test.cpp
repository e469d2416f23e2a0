// Warnings that come and go faster than the driver can list them.

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

/// A device that warns WV, which may hide a lost reference, in every second answer.
class FlickeringZaber : public ZaberEmulator {
 public:
  using ZaberEmulator::ZaberEmulator;
  bool flickers = false;

 protected:
  void process(const std::string& bytes, double time) override {
    ZaberEmulator::process(bytes, time);
    if (!flickers || bytes.find('\n') == std::string::npos) return;
    if (std::exchange(warns_, !warns_)) {
      ZaberEmulator::process("/1 0 warnings clear\n", time);
    } else {
      failNextCommand("WV");
    }
  }

 private:
  bool warns_ = false;
};

class ZaberWarnings : public DriverTest<TestedZaber> {
 protected:
  ZaberWarnings() { rig_ = std::make_unique<Rig>(TestedZaber::config(), device_); }
  void expectFault() {
    EXPECT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 5));
    EXPECT_NE(rig_->driver().reason().find("its warnings do not stay the same"), std::string::npos)
        << rig_->driver().reason();
    EXPECT_NE(rig_->driver().reason().find("axis 1 of device 1"), std::string::npos) << rig_->driver().reason();
    EXPECT_FALSE(rig_->driver().reading());
  }

  std::shared_ptr<FlickeringZaber> device_ = std::make_shared<FlickeringZaber>();
};

TEST_F(ZaberWarnings, ThatNeverStayTheSameAtTheStartAreAFaultThatSaysSo) {
  device_->flickers = true;
  expectFault();
}

TEST_F(ZaberWarnings, ThatNeverStayTheSameWhileItWorksAreAFaultThatSaysSo) {
  start();
  moveAndCheck();
  device_->flickers = true;
  expectFault();
}

TEST_F(ZaberWarnings, TheFaultIsClearedOnceTheyStayTheSame) {
  device_->flickers = true;
  expectFault();
  rig_->run(3);
  rig_->driver().clearFault();
  rig_->run(3);
  expectFault();
  device_->flickers = false;
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady()) << rig_->driver().reason();
  moveAndCheck();
}

}  // namespace
}  // namespace microinjection
