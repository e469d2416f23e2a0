// 200,000 malformed or reordered replies a protocol, to a driver at work, while the device refuses and misses commands:
// no pulse is told as done that was not, no pressure as valid that is not there, and when the line is sound again it
// works again.

#include <gtest/gtest.h>

#include "hardware/injector/injector_bench.h"
#include "hardware/serial/damage.h"

namespace microinjection {
namespace {

constexpr int kRepliesAtOnce = 4000;  // between two looks whether it works
constexpr double kSettled = 1;        // s, after which a balance pressure that was sent is told, or a fault

constexpr double kRest = 0.02;  // s, four time constants of what is told of a regulator

/// The device behind a line that damages a quarter of its replies.
class DamagedLine : public DeviceEmulator {
 public:
  explicit DamagedLine(std::shared_ptr<DeviceEmulator> device) : device_(std::move(device)) {}

  void setDamaging(bool damaging) { damaging_ = damaging; }
  int damaged() const { return damaged_; }

 protected:
  void process(const std::string& bytes, double time) override { device_->receive(bytes, time); }
  std::string produce(double time) override {
    const std::string reply = device_->send(time);
    if (reply.empty() || !damaging_ || damage_.below(4) != 0) return reply;
    const std::string arrives = damage_(reply);
    damaged_ += arrives == reply ? 0 : 1;
    return arrives;
  }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  std::shared_ptr<DeviceEmulator> device_;
  Damage damage_{7};
  bool damaging_ = false;
  int damaged_ = 0;
};

/// With shorter time-outs, so that it takes less virtual time.
YAML::Node impatient(const std::string& name) {
  YAML::Node file = injectorFile(name), serial = file["serial"];
  const double timeout = name == "arduino" ? 0.5 : 0.08;  // s; it takes 0.25 s a command, and some are late
  serial["quiet"] = 0.03;
  serial["query_period"] = 0.02;
  for (const char* command : {"begin", "pulse", "verify", "balance", "stop"}) {
    for (YAML::Node exchange : serial[command]) exchange["timeout"] = timeout;
  }
  serial["query"]["timeout"] = timeout;
  return file;
}

class InjectorFuzz : public ::testing::TestWithParam<std::string> {
 protected:
  const int replies_ = GetParam() == "arduino" ? 50000 : 200000;  // all of an Arduino's have one form

  static std::shared_ptr<InjectorEmulator> emulatorOf(const std::string& name) {
    for (const Injector& each : injectors()) {
      if (each.name == name) return each.make_emulator();
    }
    return nullptr;
  }

  std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_); }

  void harmDevice() {
    const std::string code = GetParam() == "femtojet" ? "007" : "?";
    const Fault faults[] = {{Fault::Kind::kError, 0, code, bench.time()},
                            {Fault::Kind::kDeaf, 1.0 + double(below(4)), "", bench.time()},
                            {Fault::Kind::kSilence, 0.1, "", bench.time()}};
    emulator->inject(faults[below(3)]);
  }

  void command() {
    if (below(100) == 0 &&
        bench.device().pulse({id_ + 1, InjectorBench::kPressure, shortest_ + 0.1 * double(below(3))}).empty()) {
      ++id_;
    }
    if (below(1000) == 0 && bench.device().setBalance(bench.balance() + 100 * double(below(6))).empty()) {
      balanced_ = bench.time();
      balancing_ = true;
    }
    if (below(100) == 0) bench.device().stop();
    if (below(10) == 0 && !bench.device().fault().empty()) bench.device().reset();
    if (below(100) == 0) harmDevice();
  }

  void judge() {
    const InjectorReading& told = bench.device().reading();
    ASSERT_LE(told.pulses, bench.ended()) << "told as done";
    if (!bench.device().fault().empty() || told.busy || told.pressure != told_) troubled_ = bench.time();
    told_ = told.pressure;
    // A balance pressure that was asked for waits while there is trouble, and is then under way for a moment.
    if (balancing_ && troubled_ == bench.time()) balanced_ = bench.time();
    if (bench.time() - troubled_ < kRest || bench.time() - balanced_ < kSettled) return;
    balancing_ = false;
    ASSERT_NEAR(told.pressure, bench.pressure(), 1) << "told as valid";
    ++judged_;
  }

  void checkThatItWorks() {
    line->setDamaging(false);
    bench.run(8);
    bench.device().reset();
    bench.run(3);
    ASSERT_EQ(bench.device().fault(), "");
    const unsigned begun = bench.begun(), told = bench.device().reading().pulses;
    ASSERT_EQ(bench.device().pulse({++id_, InjectorBench::kPressure, shortest_ + 0.2}), "");
    bench.run(2);
    ASSERT_EQ(bench.begun(), begun + 1) << bench.device().fault();
    ASSERT_EQ(bench.device().reading().pulses, told + 1);
    line->setDamaging(true);
  }

  std::shared_ptr<InjectorEmulator> emulator = emulatorOf(GetParam());
  std::shared_ptr<DamagedLine> line = std::make_shared<DamagedLine>(emulator);
  InjectorBench bench{GetParam(), impatient(GetParam()), line, emulator};
  std::mt19937 random_{11};
  const double shortest_ = std::max(0.1, InjectorFile(injectorFile(GetParam())).model.limits.duration_range[0]);  // s
  std::uint64_t id_ = 0;
  double told_ = 0;      // Pa, in the last step
  double troubled_ = 0;  // s, when it was no valid pressure, or changed, last
  double balanced_ = 0;  // s, when another balance pressure was asked for last, or waited
  bool balancing_ = false;
  int judged_ = 0;
};

TEST_P(InjectorFuzz, NothingIsToldThatIsNotSo) {
  bench.run(2);
  for (int end = 0; line->damaged() < replies_;) {
    ASSERT_NO_FATAL_FAILURE(checkThatItWorks());
    for (end += kRepliesAtOnce; line->damaged() < end;) {
      command();
      bench.step();
      ASSERT_NO_FATAL_FAILURE(judge()) << "after " << line->damaged() << " damaged replies, at " << bench.time()
                                       << " s";
    }
  }
  auto& driver = dynamic_cast<SerialInjector&>(bench.device());
  std::printf(
      "%d damaged replies in %.0f s of virtual time, %u that were none; %u of %u pulses told as done; %d looks\n",
      line->damaged(), bench.time(), driver.badReplies(), driver.reading().pulses, bench.ended(), judged_);
  EXPECT_GT(driver.badReplies(), unsigned(replies_ / 4));
  EXPECT_GT(driver.reading().pulses, 100U);
  EXPECT_GT(judged_, replies_ / 20);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const Injector& each : injectors()) all.push_back(each.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(All, InjectorFuzz, ::testing::ValuesIn(names()), [](const auto& name) { return name.param; });

}  // namespace
}  // namespace microinjection
