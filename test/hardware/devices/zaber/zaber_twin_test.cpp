// Two devices with one address on a line: as delivered, every one has address 1.

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

/// Both hear all, and both answer.
class TwinEmulator : public ManipulatorEmulator {
 public:
  TwinEmulator(const ZaberEmulatorConfig& one, const ZaberEmulatorConfig& other) : one_(one), other_(other) {}

  Eigen::Vector3d position() const override { return one_.position(); }
  int movesBegun() const override { return one_.movesBegun() + other_.movesBegun(); }
  bool moves() const override { return one_.moves() || other_.moves(); }
  void shiftByHand(const Eigen::Vector3d& displacement) override { one_.shiftByHand(displacement); }
  void connect(bool both) { both_ = both; }

 protected:
  void process(const std::string& bytes, double time) override {
    one_.receive(bytes, time);
    if (both_) other_.receive(bytes, time);
  }
  std::string produce(double time) override {
    const std::string first = one_.send(time), second = other_.send(time);
    return both_ ? first + second : first;
  }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  ZaberEmulator one_, other_;
  bool both_ = true;
};

class ZaberTwinTest : public DriverTest<TestedZaber> {
 protected:
  /// `start` (m): where the second device is.
  void connect(double start, int serial, bool numbers = true) {
    ZaberEmulatorConfig other;
    other.start = start;
    other.serial = serial;
    twins_ = std::make_shared<TwinEmulator>(ZaberEmulatorConfig(), other);
    ZaberConfig driver = TestedZaber::config();
    driver.numbers = numbers;
    rig_ = std::make_unique<Rig>(driver, twins_);
  }
  bool fails() {
    return rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 3);
  }
  std::shared_ptr<TwinEmulator> twins_;
};

TEST_F(ZaberTwinTest, AnotherPlaceIsAFaultThatNamesTheAddress) {
  connect(3e-3, 12340);
  ASSERT_TRUE(fails()) << rig_->driver().reason();
  for (const char* part : {"two devices have the address 1", "an address of its own"})
    EXPECT_NE(rig_->driver().reason().find(part), std::string::npos) << rig_->driver().reason();
  rig_->run(2, [&] { rig_->driver().moveTo(kPlace, 1e-3); });
  EXPECT_EQ(twins_->movesBegun(), 0);
}

TEST_F(ZaberTwinTest, AtTheSamePlaceTheSerialNumberTells) {
  connect(ZaberEmulatorConfig().start, 770);
  ASSERT_TRUE(fails()) << rig_->driver().reason();
  EXPECT_NE(rig_->driver().reason().find("\"771\""), std::string::npos) << rig_->driver().reason();
  EXPECT_EQ(twins_->movesBegun(), 0);
}

TEST_F(ZaberTwinTest, OneThatIsTakenOffIsForgottenWhenTheFaultIsCleared) {
  connect(3e-3, 12340);
  ASSERT_TRUE(fails());
  twins_->connect(false);
  rig_->run(0.2);
  EXPECT_EQ(rig_->driver().state(), State::kFault);
  rig_->driver().clearFault();
  ASSERT_TRUE(rig_->runUntilReady()) << rig_->driver().reason();
}

TEST_F(ZaberTwinTest, OneThatComesWhileTheAxesAreUsedStopsThem) {
  connect(3e-3, 12340);
  twins_->connect(false);
  ASSERT_TRUE(rig_->runUntilReady()) << rig_->driver().reason();
  rig_->driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), 1e-3);
  rig_->run(0.3);
  ASSERT_TRUE(twins_->moves());
  twins_->connect(true);
  ASSERT_TRUE(rig_->runUntil([&] { return rig_->driver().state() == State::kFault; }, 0.2));
  ASSERT_TRUE(rig_->runUntil([&] { return !twins_->moves(); }, 0.2));
}

TEST_F(ZaberTwinTest, ALineThatRepeatsAnAnswerIsNoTwin) {
  class Doubled : public ZaberEmulator {
   protected:
    std::string produce(double time) override {
      const std::string lines = ZaberEmulator::produce(time);
      return lines + lines;
    }
  };
  rig_ = std::make_unique<Rig>(TestedZaber::config(), std::make_shared<Doubled>());
  ASSERT_TRUE(rig_->runUntilReady()) << rig_->driver().reason();
  moveAndCheck();
}

}  // namespace
}  // namespace microinjection
