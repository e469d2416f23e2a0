// What a driver says to a port behind which another device is: nothing that could move it.

#include "hardware/devices/port_probe.h"

#include "hardware/devices/driver_fixture.h"
#include "hardware/devices/known_answers.h"
#include "hardware/serial/scripted_wire.h"

namespace microinjection {
namespace {

/// A Sutter MPC-200, after its maker's manual and Micro-Manager's adapter: single letters without an end, of which M
/// and S take the bytes behind them for a place to move to, H, Y and N move to places of its own, and C tells where it
/// is.
class Mpc200 {
 public:
  std::string receive(const std::string& bytes) {
    std::string answer;
    for (const char each : bytes) {
      if (expected_ > 0) {
        if (--expected_ == 0) ++moves;
      } else if (each == 'M') {
        expected_ = 12;
      } else if (each == 'S') {
        expected_ = 13;
      } else if (each == 'H' || each == 'Y' || each == 'N') {
        ++moves;
      } else if (each == 'C') {
        answer += std::string("\x01\x10\x27\0\0\x10\x27\0\0\x10\x27\0\0\r", 14);
      }
    }
    return answer;
  }
  bool waits() const { return expected_ > 0; }  ///< for the rest of a move
  int moves = 0;

 private:
  int expected_ = 0;  // bytes
};

template <typename Tested>
class PortProbeTest : public testing::Test {
 protected:
  /// Steps of 1 ms; `other` answers what was written.
  void run(double duration, const std::function<std::string(const std::string&)>& other) {
    for (const double end = time_ + duration; time_ < end;) {
      driver_->step(time_ += 1e-3);
      for (; heard_ < script_.sent.size(); ++heard_) script_.incoming += other(script_.sent[heard_]);
    }
  }
  std::string said() const {
    std::string all;
    for (const std::string& bytes : script_.sent) all += bytes;
    return all;
  }

  WireScript script_;
  std::unique_ptr<typename Tested::Driver> driver_ =
      std::make_unique<typename Tested::Driver>(Tested::config(), std::make_unique<ScriptedWire>(script_));
  std::size_t heard_ = 0;
  double time_ = 0;
};

TYPED_TEST_SUITE(PortProbeTest, AllTested, Names);

TYPED_TEST(PortProbeTest, AnMpc200IsNotMoved) {
  Mpc200 other;
  this->run(20, [&](const std::string& bytes) { return other.receive(bytes); });
  EXPECT_EQ(other.moves, 0);
  EXPECT_FALSE(other.waits()) << "the next bytes would be the end of a move";
  EXPECT_EQ(this->driver_->state(), ManipulatorDevice::State::kFault);
  EXPECT_FALSE(this->driver_->reading());
  this->driver_->clearFault();
  this->run(20, [&](const std::string& bytes) { return other.receive(bytes); });
  this->driver_.reset();  // and at the end
  for (; this->heard_ < this->script_.sent.size(); ++this->heard_) other.receive(this->script_.sent[this->heard_]);
  EXPECT_EQ(other.moves, 0);
  EXPECT_FALSE(other.waits());
  other.receive(this->script_.guarded_stop);  // of the process that watches over this one
  EXPECT_EQ(other.moves, 0);
  EXPECT_FALSE(other.waits());
}

/// The devices whose words another one could misunderstand ask first.
using Asking = testing::Types<TestedZaber, TestedScientifica>;
template <typename Tested>
class AskingDriverTest : public PortProbeTest<Tested> {};
TYPED_TEST_SUITE(AskingDriverTest, Asking, Names);

TYPED_TEST(AskingDriverTest, ListensThenAsksAndSaysNothingElse) {
  this->run(0.09, [](const std::string&) { return ""; });
  EXPECT_EQ(this->said(), "") << "it listens first";
  this->run(10, [](const std::string&) { return ""; });
  const std::string question = this->script_.sent.front();
  for (const std::string& bytes : this->script_.sent) EXPECT_EQ(bytes, question);
  EXPECT_EQ(this->driver_->state(), ManipulatorDevice::State::kFault);
  EXPECT_NE(this->driver_->reason().find("no reply"), std::string::npos) << this->driver_->reason();
  EXPECT_EQ(this->script_.guarded_stop, "") << "nor does a guard";
  const std::size_t sent = this->script_.sent.size();
  this->driver_->stop();
  this->run(1, [](const std::string&) { return ""; });
  EXPECT_EQ(this->script_.sent.size(), sent);
  this->driver_->clearFault();
  this->run(1, [](const std::string&) { return ""; });
  EXPECT_GT(this->script_.sent.size(), sent) << "enable asks again";
}

TYPED_TEST(AskingDriverTest, NamesWhatAnswers) {
  const std::string name = std::string(TypeParam::kName) == "zaber" ? "a Scientifica" : "a Zaber";
  const std::string answer = name == "a Zaber" ? "@01 0 OK IDLE -- 0\r\n" : "E,3\r";
  this->run(10, [&](const std::string&) { return answer; });
  EXPECT_EQ(this->driver_->state(), ManipulatorDevice::State::kFault);
  EXPECT_NE(this->driver_->reason().find(name + " answers"), std::string::npos) << this->driver_->reason();
}

/// Of its emulator, the line is cut while it moves.
template <typename Tested>
class AskingRigTest : public DriverTest<Tested> {};
TYPED_TEST_SUITE(AskingRigTest, Asking, Names);

TYPED_TEST(AskingRigTest, ADeviceThatWasKnownIsStoppedAlthoughItDoesNotAnswer) {
  this->start();
  auto& rig = *this->rig_;
  rig.driver().moveTo(kPlace + Eigen::Vector3d(5e-3, 0, 0), 1e-3);
  rig.run(0.3);
  ASSERT_TRUE(rig.device().moves());
  rig.wire().disconnectCable();
  rig.run(0.6);
  rig.inject("drop:100000");  // it hears, and cannot be heard
  rig.wire().connectCable();
  ASSERT_TRUE(rig.runUntil([&] { return !rig.device().moves(); }, 4.5));
  EXPECT_LT(rig.place().x(), 4.9e-3) << "before the end of its move";
}

TEST(NameOfAnswer, KnowsTheDevicesOfAnInjectionRig) {
  const std::vector<std::pair<std::string, std::string>> answers = {
      {"@01 0 OK IDLE -- 0\r\n", "a Zaber"},
      {"!01 1 IDLE --\r\n", "a Zaber"},
      {"A007 4\r", "an Eppendorf"},
      {"ERR=003\r\n", "an Eppendorf"},
      {"E,3\r", "a Scientifica"},
      {"A\r", "a Scientifica"},
      {"100\t-20\t3\r", "a Scientifica"},
      {std::string("\x01\0\0\0\x02\0\0\0\x03\0\0\0\r", 13), "a Sutter MP-285"},
      {std::string("\x01\x01\0\0\0\x02\0\0\0\x03\0\0\0\r", 14), "a Sutter MPC-200"},
      {"=\r", "a Sutter MP-285"},
      {"AT\r\nAT\r\n", "a modem"},
      {"RING\r\n", "a modem"},
      {"2.5012,2.4999\r\n2.5013,2.5001\r\n", "a stream of numbers, such as a force sensor's voltages"},
      {"$GPGGA,1,2\r\n", "a GPS receiver"},
      {"raspberrypi login: ", "a login on another computer"},
      {"hello\r\n", "something that says \"hello  \""},
      {"", ""}};
  for (const auto& [bytes, name] : answers) EXPECT_EQ(nameOfAnswer(bytes), name) << bytes;
}

}  // namespace
}  // namespace microinjection
