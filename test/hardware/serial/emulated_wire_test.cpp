#include "hardware/serial/emulated_wire.h"

#include <gtest/gtest.h>

#include <utility>

namespace microinjection {
namespace {

/// Answers each byte with the next of the alphabet.
class Next : public DeviceEmulator {
 protected:
  void process(const std::string& bytes, double) override {
    for (const char each : bytes) said_ += static_cast<char>(each + 1);
  }
  std::string produce(double) override { return std::exchange(said_, ""); }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}
  std::string said_;
};

TEST(EmulatedWire, TakesTheLinesTimeBothWays) {
  EmulatedWire wire(std::make_shared<Next>(), 1000);  // 10 ms a byte
  EXPECT_EQ(wire.open(), "");
  wire.write("ab", 0);
  EXPECT_EQ(wire.read(0.0199), "");  // the first is heard at 10 ms and its answer here at 20 ms
  EXPECT_EQ(wire.read(0.0201), "b");
  EXPECT_EQ(wire.read(0.0301), "c");
}

TEST(EmulatedWire, APulledCableLosesWhatIsOnItsWay) {
  EmulatedWire wire(std::make_shared<Next>(), 1000);
  EXPECT_EQ(wire.open(), "");
  wire.write("a", 0);
  EXPECT_EQ(wire.read(0.012), "");
  wire.disconnectCable();
  EXPECT_FALSE(wire.isOpen());
  EXPECT_NE(wire.open(), "");
  wire.write("b", 0.02);
  EXPECT_EQ(wire.read(0.1), "");
  wire.connectCable();
  EXPECT_EQ(wire.open(), "");
  EXPECT_EQ(wire.read(1), "");
  wire.write("c", 1);
  EXPECT_EQ(wire.read(2), "d");
}

}  // namespace
}  // namespace microinjection
