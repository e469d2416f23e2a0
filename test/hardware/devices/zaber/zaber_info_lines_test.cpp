// Info lines may come at any time; a line of which they are a part is silent all the same.

#include <utility>

#include "hardware/devices/driver_fixture.h"

namespace microinjection {
namespace {

/// A Zaber that sends a line of its own every `period` (s).
class TalkativeZaber : public ManipulatorEmulator {
 public:
  TalkativeZaber(std::string line, double period) : line_(std::move(line)), period_(period) {}

  Eigen::Vector3d position() const override { return device_.position(); }
  int movesBegun() const override { return device_.movesBegun(); }
  bool moves() const override { return device_.moves(); }
  void shiftByHand(const Eigen::Vector3d& way) override { device_.shiftByHand(way); }

 protected:
  void process(const std::string& bytes, double time) override { device_.receive(bytes, time); }
  std::string produce(double time) override {
    std::string said = device_.send(time);
    for (; next_ <= time; next_ += period_) said += line_;
    return said;
  }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  ZaberEmulator device_;
  std::string line_;
  double period_, next_ = 0;  // s
};

class ZaberInfoLinesTest : public DriverTest<TestedZaber> {
 protected:
  void makeTalkative(const std::string& line, double period) {
    rig_ = std::make_unique<Rig>(TestedZaber::config(), std::make_shared<TalkativeZaber>(line, period));
  }
};

TEST_F(ZaberInfoLinesTest, AreNoNoise) {
  makeTalkative("#01 0 temperature 38\r\n", 8e-3);
  start();
  moveAndCheck();
  rig_->driver().stop();
  rig_->run(1);
  moveAndCheck(-kPlace);
}

/// Another device on the port, or damage.
TEST_F(ZaberInfoLinesTest, OtherLinesAre) {
  for (const char* line : {"temperature 38\r\n", "#\x01\x02\n", "!01 1 IDLE --\r\n", "\xff"}) {
    SCOPED_TRACE(line);
    makeTalkative(line, 8e-3);
    rig_->run(7);
    EXPECT_EQ(rig_->driver().state(), State::kFault);
    EXPECT_NE(rig_->driver().reason().find("the line is never silent"), std::string::npos) << rig_->driver().reason();
  }
}

}  // namespace
}  // namespace microinjection
