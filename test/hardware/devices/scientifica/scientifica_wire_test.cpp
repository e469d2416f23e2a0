// A card that was switched off and on talks at 9600 baud, whatever the file says.

#include "hardware/devices/scientifica/scientifica_wire.h"

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

/// A card, and the rate at which it talks. At another one each side hears bytes that are none of its own.
struct BaudCard {
  std::shared_ptr<ScientificaEmulator> device = std::make_shared<ScientificaEmulator>();
  int baud = 38400;
};

class BaudWire : public EmulatedWire {
 public:
  BaudWire(BaudCard& card, int baud) : EmulatedWire(card.device, card.baud), card_(card), baud_(baud) {}
  std::string read(double time) override {
    std::string bytes = EmulatedWire::read(time);
    if (baud_ != card_.baud) bytes = std::string(bytes.size() / 4, '\xf8');
    return bytes;
  }
  void write(const std::string& bytes, double time) override {
    EmulatedWire::write(baud_ == card_.baud ? bytes : std::string(bytes.size(), '\xe6'), time);
  }

 private:
  BaudCard& card_;
  int baud_;
};

class ScientificaBaudTest : public testing::Test {
 protected:
  using State = ManipulatorDevice::State;
  void makeDriver(int baud_of_file) {
    auto wire = std::make_unique<ScientificaWire>(baud_of_file,
                                                  [this](int baud) { return std::make_unique<BaudWire>(card_, baud); });
    wire_ = wire.get();
    ScientificaConfig config = TestedScientifica::config();
    config.port.baud = baud_of_file;
    driver_ = std::make_unique<ScientificaDriver>(config, std::move(wire));
  }
  bool until(const std::function<bool()>& done, double longest) {
    for (const double end = time_ + longest; time_ < end;) {
      driver_->step(time_ += 1e-3);
      reasons_ += driver_->reason();
      if (done()) return true;
    }
    return false;
  }
  bool ready() const { return driver_->state() == State::kReady; }

  BaudCard card_;
  ScientificaWire* wire_ = nullptr;
  std::unique_ptr<ScientificaDriver> driver_;
  std::string reasons_;
  double time_ = 0;  // s
};

TEST_F(ScientificaBaudTest, ACardIsFoundAtEitherRate) {
  for (const int of_card : {9600, 38400}) {
    for (const int of_file : {9600, 38400}) {
      SCOPED_TRACE(testing::Message() << of_card << ", file " << of_file);
      card_ = BaudCard{};
      card_.baud = of_card;
      reasons_.clear();
      makeDriver(of_file);
      ASSERT_TRUE(until([&] { return ready(); }, 10)) << driver_->reason();
      EXPECT_EQ(wire_->baud(), of_card);
      EXPECT_EQ(reasons_.find("no reply at") != std::string::npos, of_card != of_file);
      driver_->moveTo(kPlace, 1e-3);
      EXPECT_TRUE(
          until([&] { return (driver_->reading()->joints - kPlace).norm() < 0.1e-6 && !driver_->moving(); }, 5));
    }
  }
}

/// It counts from 0 then: it is found again, and its coordinates are not believed.
TEST_F(ScientificaBaudTest, ACardThatWasSwitchedOffAndOnIsFoundAndNotBelieved) {
  makeDriver(38400);
  ASSERT_TRUE(until([&] { return ready(); }, 10));
  driver_->moveTo(kPlace, 1e-3);
  ASSERT_TRUE(until([&] { return !driver_->moving(); }, 5));
  card_.device->inject(parseFault("error:RESET"));
  card_.baud = 9600;
  ASSERT_TRUE(until([&] { return driver_->state() == State::kFault && wire_->baud() == 9600; }, 20));
  until([] { return false; }, 5);
  driver_->clearFault();
  ASSERT_TRUE(until([&] { return ready() || driver_->reason().find("began anew") != std::string::npos; }, 10))
      << driver_->reason();
  driver_->clearFault();
  ASSERT_TRUE(until([&] { return ready(); }, 10)) << driver_->reason();
  EXPECT_EQ(wire_->baud(), 9600);
  EXPECT_NE(reasons_.find("no reply at 38400 baud; trying 9600 baud"), std::string::npos);
}

TEST_F(ScientificaBaudTest, WithoutACardBothAreNamed) {
  card_.baud = 4800;
  makeDriver(38400);
  until([] { return false; }, 8);
  EXPECT_NE(driver_->state(), State::kReady);
  for (const char* told : {"no reply at 38400 baud; trying 9600 baud", "no reply at 9600 baud; trying 38400 baud"}) {
    EXPECT_NE(reasons_.find(told), std::string::npos) << told;
  }
}

}  // namespace
}  // namespace microinjection
