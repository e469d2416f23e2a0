// A driver that begins anew leaves the device's pressure as it is, and a suction of a real device has a limit.

#include "hardware/injector/dialogue_fixture.h"
#include "hardware/injector/serial_injector_fixture.h"

namespace microinjection {
namespace {

class KeptPressureTest : public testing::Test {
 protected:
  explicit KeptPressureTest(const std::string& confirm = "")
      : injector{std::make_unique<ScriptedWire>(script),
                 testProtocol("pulse: [{send: P, expect: OK}]\nbalance: [{send: 'C{pressure:1}', expect: OK}]\n"
                              "query: {send: '?', expect: '=([-0-9.]+)'" +
                              confirm +
                              "}\npressure_unit: 100\nrefuse: 'ERR'\nterminator: CR\n"
                              "pulse_pressure: 1\npulse_duration: 1"),
                 model(), SerialInjector::Start::kKeep} {}
  static InjectorModelConfig model() {
    InjectorModelConfig config;
    config.balance = 0;
    return config;
  }
  void run(double duration) {
    for (const double end = time + duration; time < end;) {
      injector.step(time += 0.01);
      for (; answered < script.sent.size(); ++answered) {
        const std::string line = script.sent[answered];
        if (deaf) continue;
        if (line[0] == 'C') pressure = line.substr(1, line.size() - 2);
        script.incoming += line[0] == '?' ? "=" + pressure + "\r" : "OK\r";
      }
    }
  }
  void breakLine() {
    script.open = false;
    script.refusal = "no cable";
  }
  long balances() const {
    return std::count_if(script.sent.begin(), script.sent.end(), [](const auto& line) { return line[0] == 'C'; });
  }

  WireScript script;
  SerialInjector injector;
  std::string pressure = "-20.0";  // hPa, that the device has from before
  std::size_t answered = 0;
  double time = 0;
  bool deaf = false;
};

TEST_F(KeptPressureTest, ItIsAskedForAndNotSet) {
  EXPECT_FALSE(injector.pressureKnown());
  run(1);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(balances(), 0);
  EXPECT_TRUE(injector.pressureKnown());
  EXPECT_NEAR(injector.reading().pressure, -2000, 1e-9);
}

TEST_F(KeptPressureTest, AfterABrokenLineItIsSetAnewOnlyIfItWasSet) {
  run(1);
  breakLine();
  run(0.1);
  EXPECT_NE(injector.fault(), "");
  EXPECT_FALSE(injector.pressureKnown());
  script.refusal.clear();
  run(2);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(balances(), 0);
  ASSERT_EQ(injector.setBalance(-1000), "");
  run(0.5);
  EXPECT_EQ(balances(), 1);
  EXPECT_NEAR(injector.reading().pressure, -1000, 1);
  breakLine();
  run(0.1);
  script.refusal.clear();
  run(2);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(balances(), 2);
  EXPECT_EQ(pressure, "-10.0");
}

TEST_F(KeptPressureTest, AResetSetsNothingEither) {
  run(1);
  deaf = true;
  run(5);
  EXPECT_NE(injector.fault(), "");
  injector.reset();
  deaf = false;
  run(2);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(balances(), 0);
}

class ConfirmedPressureTest : public KeptPressureTest {
 protected:
  ConfirmedPressureTest() : KeptPressureTest(", confirm: pressure") {}
};

TEST_F(ConfirmedPressureTest, WhatItHadIsNoFaultAndWhatItIsToldIsConfirmed) {
  run(1);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_NEAR(injector.reading().pressure, -2000, 1e-9);
  ASSERT_EQ(injector.setBalance(-1000), "");
  run(1);
  EXPECT_EQ(injector.fault(), "");
  pressure = "-20.0";  // a knob was turned
  run(1);
  EXPECT_NE(injector.fault().find("query"), std::string::npos) << injector.fault();
}

class DrawLimitTest : public SerialInjectorTest {
 protected:
  DrawLimitTest() {
    model.balance = 0;
    model.draw_limit = 1e-15;
    model.limits.pressure_range[0] = 0;
  }
  static constexpr double kRest = 541;  // Pa, of the default pipette; the line has tenths of a hectopascal
};

TEST_F(DrawLimitTest, ADeviceThatDrawsInGetsThePressureAtWhichNothingFlows) {
  SerialInjector limited(std::make_unique<ScriptedWire>(script), testProtocol(), model);
  const double flow = -PipetteFlow(model.pipette).flow(0), until = model.draw_limit / flow;
  double sent_at = 0;
  bool was_limited = false;
  for (int i = 1; i * 0.01 < until + 2; ++i) {
    limited.step(i * 0.01);
    if (limited.reading().limited && !was_limited) {
      was_limited = true;
      EXPECT_NE(limited.setBalance(0).find("draw_limit"), std::string::npos);
    }
    if (script.sent.size() == answered) continue;
    const std::string line = script.sent.back();
    answered = script.sent.size();
    script.incoming = line[0] == '?' ? "=0.0\r" : "OK\r";
    if (line == "C5.5\r") sent_at = i * 0.01;
  }
  EXPECT_GT(sent_at, until - 0.05) << "not before the limit";
  EXPECT_LT(sent_at, until + 0.8) << "a line that is busy delays it";
  EXPECT_TRUE(was_limited);
  EXPECT_EQ(limited.fault(), "");
  EXPECT_LT(limited.reading().drawn, 1.001 * model.draw_limit);
  EXPECT_EQ(limited.setBalance(2000), "");
}

TEST_F(DrawLimitTest, ADeviceThatIsSetByHandIsAFault) {
  SerialInjector limited(std::make_unique<ScriptedWire>(script),
                         testProtocol("pulse: [{send: 'P{pressure_hPa:1} {duration_ms:0}', expect: OK}]\n"
                                      "refuse: ERR\nterminator: CR\n"),
                         model);
  for (int i = 1; i < 2000 && limited.fault().find("draw_limit") == std::string::npos; ++i) limited.step(i * 0.01);
  EXPECT_NE(limited.fault().find("draw_limit is reached, and the device draws in on: "), std::string::npos)
      << limited.fault();
}

}  // namespace
}  // namespace microinjection
