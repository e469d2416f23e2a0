// What every injector keeps to: the model, and each real one's protocol and driver on its emulator.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <sstream>

#include "base/errors.h"
#include "hardware/injector/femtojet_emulator.h"
#include "hardware/injector/injector_bench.h"

namespace microinjection {
namespace {

constexpr double kDuration = 0.5;  // s

class InjectorContract : public ::testing::TestWithParam<std::string> {
 protected:
  void expectWorks(std::uint64_t id) {
    const unsigned before = bench.begun();
    ASSERT_EQ(device().fault(), "");
    ASSERT_EQ(device().pulse({id, InjectorBench::kPressure, kDuration}), "");
    bench.run(3);
    EXPECT_EQ(device().fault(), "");
    EXPECT_EQ(bench.begun(), before + 1);
    EXPECT_EQ(device().reading().last_id, id);
    EXPECT_FALSE(device().reading().busy);
  }
  void expectBalanced() { EXPECT_NEAR(device().reading().pressure, bench.pressure(), 1e-6); }
  InjectorDevice& device() { return bench.device(); }

  InjectorBench bench{GetParam()};
};

TEST_P(InjectorContract, TheBalancePressureIsThereFromTheStart) {
  if (bench.real()) EXPECT_NE(device().pulse({1, InjectorBench::kPressure, kDuration}), "") << "nothing is known yet";
  bench.run(1);
  EXPECT_EQ(device().fault(), "");
  EXPECT_NEAR(bench.pressure(), bench.balance(), 1e-6);
  expectBalanced();
}

TEST_P(InjectorContract, APulseIsDoneOnceAndAsLongAsAsked) {
  bench.run(1);
  ASSERT_EQ(device().pulse({5, InjectorBench::kPressure, kDuration}), "");
  EXPECT_TRUE(device().reading().busy);
  for (int i = 0; i < 600; ++i) {
    bench.step();
    // The model's pressure falls for a while after its pulse is over.
    EXPECT_LE(device().reading().pulses, bench.real() ? bench.ended() : bench.begun()) << "told before it was over";
  }
  EXPECT_EQ(device().fault(), "");
  EXPECT_EQ(bench.begun(), 1U);
  EXPECT_EQ(bench.ended(), 1U);
  EXPECT_GE(bench.underPulse(), kDuration - 0.015);
  EXPECT_LE(bench.underPulse(), kDuration + 0.045) << "a reply at 9600 baud, and two steps";
  EXPECT_EQ(device().reading().pulses, 1U);
  EXPECT_EQ(device().reading().last_id, 5U);
  EXPECT_FALSE(device().reading().busy);
  EXPECT_GT(device().reading().volume, 0);
  expectBalanced();
  expectWorks(6);
}

TEST_P(InjectorContract, OnePulseAtATime) {
  bench.run(1);
  ASSERT_EQ(device().pulse({5, InjectorBench::kPressure, kDuration}), "");
  EXPECT_EQ(device().pulse({6, InjectorBench::kPressure, kDuration}), "a pulse is under way");
  bench.run(0.3);
  EXPECT_EQ(device().pulse({7, InjectorBench::kPressure, kDuration}), "a pulse is under way");
  bench.run(2);
  EXPECT_EQ(bench.begun(), 1U);
}

TEST_P(InjectorContract, RefusesWhatItCannotDo) {
  bench.run(1);
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY), 1e9, -1e9}) {
    EXPECT_NE(device().pulse({1, bad, kDuration}), "") << bad;
    EXPECT_NE(device().pulse({1, InjectorBench::kPressure, bad}), "") << bad;
    EXPECT_NE(device().setBalance(bad), "") << bad;
  }
  EXPECT_NE(device().pulse({1, InjectorBench::kPressure, 0}), "");
  bench.run(1);
  EXPECT_EQ(bench.begun(), 0U);
  expectBalanced();
}

TEST_P(InjectorContract, AnotherBalancePressureIsSetOrRefused) {
  bench.run(1);
  const double wanted = bench.balance() + 200;
  const std::string refusal = device().setBalance(wanted);
  const bool obeys = refusal.empty();
  EXPECT_EQ(obeys, GetParam() != "relay");
  EXPECT_EQ(refusal.find("set by hand") != std::string::npos, !obeys) << refusal;
  bench.run(1);
  EXPECT_NEAR(bench.pressure(), obeys ? wanted : bench.balance(), 1e-6);
  expectBalanced();
  expectWorks(5);
  EXPECT_NEAR(bench.pressure(), obeys ? wanted : bench.balance(), 1e-6);
  expectBalanced();
}

/// A message of ROS gives it as absolute. Such a number is beyond the limits of most; a FemtoJet's are wider.
TEST_P(InjectorContract, TheBalanceIsGaugeAndReachesBothEnds) {
  constexpr double kAtmosphere = 101300;  // Pa
  bench.run(1);
  const double lowest = bench.range()[0], highest = bench.range()[1];
  for (const double beyond : {lowest - 100, highest + 1000, kAtmosphere + highest}) {
    std::ostringstream why;
    why << "balance pressure = " << beyond << " Pa, allowed [" << lowest << ", " << highest << "] Pa";
    EXPECT_EQ(device().setBalance(beyond), why.str());
    bench.run(0.5);
    EXPECT_NEAR(bench.pressure(), bench.balance(), 1e-6);
    expectBalanced();
  }
  if (GetParam() == "relay") return;
  const double absolute = kAtmosphere + 100 * std::round(bench.balance() / 100);
  EXPECT_EQ(device().setBalance(absolute).empty(), GetParam() == "femtojet");
  for (const double pressure : {lowest, highest, bench.balance()}) {
    EXPECT_EQ(device().setBalance(pressure), "");
    bench.run(1);
    EXPECT_NEAR(bench.pressure(), pressure, 1e-3);
    expectBalanced();
  }
  EXPECT_EQ(device().fault(), "");
  if (GetParam() != "femtojet") return;
  EXPECT_EQ(device().setBalance(absolute), "");
  bench.run(1);
  EXPECT_NEAR(bench.pressure(), absolute, 1e-3) << "nothing takes the atmosphere's off";
}

TEST_P(InjectorContract, AStopEndsAPulseOrIsRefused) {
  bench.run(1);
  EXPECT_EQ(device().stop(), "") << "there is none";
  device().pulse({5, InjectorBench::kPressure, 3});
  bench.run(1);
  ASSERT_EQ(bench.begun(), 1U);
  ASSERT_EQ(device().stop().empty(), bench.stops());
  bench.run(GetParam() == "arduino" ? 0.27 : 0.2);  // it reads 30 ms a character
  EXPECT_EQ(bench.ended(), bench.stops() ? 1U : 0U);
  EXPECT_EQ(device().reading().busy, !bench.stops());
  bench.run(3);
  EXPECT_EQ(bench.ended(), 1U);
  EXPECT_EQ(device().reading().pulses, bench.stops() ? 0U : 1U) << "one that was broken off does not count";
  expectWorks(6);
}

TEST_P(InjectorContract, AStopBeforeTheTriggerLeavesNoPulse) {
  bench.run(1);
  device().pulse({5, InjectorBench::kPressure, kDuration});
  EXPECT_EQ(device().stop(), "");
  bench.run(2);
  EXPECT_EQ(bench.begun(), 0U);
  EXPECT_EQ(device().reading().pulses, 0U);
  expectWorks(6);
}

/// Whatever goes wrong and whenever: what is told as done was done, and what was not is a fault or goes on.
class InjectorTroubles : public InjectorContract {
 protected:
  /// Does `harm` so long (s) after a pulse was asked for.
  template <typename Harm>
  void tryHarm(double after, Harm harm) {
    SCOPED_TRACE("after " + std::to_string(after) + " s");
    const unsigned told = device().reading().pulses, done = bench.ended();
    ASSERT_EQ(device().fault(), "");
    ASSERT_EQ(device().pulse({++id_, InjectorBench::kPressure, kDuration}), "");
    bench.run(after);
    harm();
    bench.run(9);
    EXPECT_LE(device().reading().pulses - told, bench.ended() - done);
    EXPECT_EQ(bench.begun(), bench.ended()) << "it flows for ever";
    if (device().reading().pulses == told) EXPECT_NE(device().fault(), "");
    if (device().fault().empty()) expectBalanced();
    device().reset();
    bench.run(3);
    expectBalanced();
    expectWorks(++id_);
  }
  template <typename Harm>
  void tryHarmAtAllTimes(Harm harm) {
    bench.run(1);
    for (double after = 0; after < 0.8; after += 0.02) ASSERT_NO_FATAL_FAILURE(tryHarm(after, harm));
  }

 private:
  std::uint64_t id_ = 0;
};

TEST_P(InjectorTroubles, ACommandThatTheDeviceRefuses) {
  const std::string code = GetParam() == "femtojet" ? "007" : "?";
  tryHarmAtAllTimes([&] { bench.emulator().inject({Fault::Kind::kError, 0, code, bench.time()}); });
}

TEST_P(InjectorTroubles, ADeviceThatIsSilentForAWhile) {
  tryHarmAtAllTimes([&] { bench.emulator().inject({Fault::Kind::kSilence, 3, "", bench.time()}); });
}

TEST_P(InjectorTroubles, BytesThatAreLostOrGarbled) {
  for (const Fault::Kind kind : {Fault::Kind::kDrop, Fault::Kind::kDeaf, Fault::Kind::kGarble}) {
    for (const int bytes : {1, 3}) {
      tryHarmAtAllTimes([&] { bench.emulator().inject({kind, double(bytes), "", bench.time()}); });
    }
  }
}

TEST_P(InjectorTroubles, ACableThatIsPulledAndPlugged) {
  tryHarmAtAllTimes([&] {
    bench.wire().disconnectCable();
    bench.run(2);
    bench.wire().connectCable();
  });
}

std::vector<std::string> realOnes() {
  std::vector<std::string> names = injectorNames();
  names.erase(names.begin());
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, InjectorContract, ::testing::ValuesIn(injectorNames()),
                         [](const auto& name) { return name.param; });
INSTANTIATE_TEST_SUITE_P(All, InjectorTroubles, ::testing::ValuesIn(realOnes()),
                         [](const auto& name) { return name.param; });

/// What a FemtoJet sends before its answer is not published: any of these must do.
TEST(Femtojet, WorksWhateverComesBeforeItsAnswers) {
  using Echo = FemtojetEmulatorConfig::Echo;
  for (const Echo echo : {Echo::kNone, Echo::kCommand, Echo::kEmptyLine}) {
    for (const char* line_end : {"\r\n", "\n"}) {
      FemtojetEmulatorConfig config;
      config.echo = echo;
      config.line_end = line_end;
      InjectorBench bench("femtojet", injectorFile("femtojet"), nullptr, std::make_shared<FemtojetEmulator>(config));
      bench.run(2);
      ASSERT_EQ(bench.device().fault(), "");
      ASSERT_EQ(bench.device().pulse({5, InjectorBench::kPressure, kDuration}), "");
      bench.run(2);
      EXPECT_EQ(bench.device().fault(), "");
      EXPECT_EQ(bench.ended(), 1U);
      EXPECT_EQ(bench.device().reading().last_id, 5U);
    }
  }
}

/// A knob that somebody has turned, or a module that was reset, is found by the next query.
TEST(Voltage, AModuleThatWasResetIsAFault) {
  InjectorBench bench("voltage");
  bench.run(2);
  bench.emulator().inject({Fault::Kind::kInterrupt, 0, "", bench.time()});
  bench.run(3);
  EXPECT_EQ(bench.device().fault().rfind("query: it reads back 00.000 instead of 0.109", 0), 0U)
      << bench.device().fault();
  EXPECT_NE(bench.device().pulse({5, InjectorBench::kPressure, kDuration}), "");
  EXPECT_EQ(bench.device().setBalance(545), "");
  bench.run(2);
  EXPECT_EQ(bench.device().fault(), "");
}

/// It cannot tell that it was reset, but hears nothing for a while.
TEST(Arduino, ABoardThatWasResetGetsItsBalanceAgain) {
  InjectorBench bench("arduino");
  bench.run(2);
  ASSERT_EQ(bench.device().fault(), "");
  bench.emulator().inject({Fault::Kind::kInterrupt, 0, "", bench.time()});
  bench.step();
  ASSERT_NEAR(bench.pressure(), 0, 1e-9);
  for (double time = 0; bench.device().fault().empty(); time += InjectorBench::kStep) {
    ASSERT_LT(time, 1.6) << "a query and its time-out";
    bench.step();
  }
  EXPECT_EQ(bench.device().fault(), "the device has not accepted the balance pressure");
  EXPECT_NE(bench.device().pulse({5, InjectorBench::kPressure, kDuration}), "");
  bench.run(3);
  EXPECT_EQ(bench.device().fault(), "");
  EXPECT_NEAR(bench.pressure(), bench.balance(), 1e-9);
}

/// A board that is reset by the opening of its line does not hear the first commands.
TEST(Arduino, ABoardThatBootsIsWaitedFor) {
  InjectorBench bench("arduino");
  bench.emulator().inject({Fault::Kind::kInterrupt, 0, "", 0});
  bench.run(4);
  EXPECT_EQ(bench.device().fault(), "");
  EXPECT_NEAR(bench.pressure(), bench.balance(), 1e-9);
}

TEST(InjectorFiles, EachHasAnEmulatorAndEachEmulatorAFile) {
  std::set<std::string> files, names;
  for (const auto& entry : std::filesystem::directory_iterator(MICROINJECTION_SOURCE_DIR "/config/injectors")) {
    files.insert(entry.path().stem());
  }
  for (const std::string& name : realOnes()) names.insert(name);
  EXPECT_EQ(files, names);
}

TEST(InjectorFiles, WithoutTheNumberThatIsNotPublishedThereIsNoFemtoJet) {
  for (const char* wrong : {"", "12", "1234", "0.1"}) {
    YAML::Node file = injectorFile("femtojet");
    file["serial"]["codes"]["inject"] = wrong;
    try {
      InjectorFile read(file);
      ADD_FAILURE() << wrong;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find("serial/codes/inject = "), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("must be 3 letters or digits, in quotes, from your device's manual"),
                std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace microinjection
