#include "hardware/injector/serial_injector_fixture.h"

#include <cmath>

namespace microinjection {
namespace {

TEST_F(SerialInjectorTest, SendsBalanceAndPulseAsTheProtocolSays) {
  run(1);
  EXPECT_EQ(script.sent.front(), "C10.0\r");
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.pulse({5, 12345, 0.25}), "");
  EXPECT_TRUE(injector.reading().busy);
  run(0.1);
  const auto sent = std::find(script.sent.begin(), script.sent.end(), "P123.5 250\r");
  EXPECT_NE(sent, script.sent.end());
  EXPECT_TRUE(injector.reading().busy);
  EXPECT_EQ(injector.pulse({6, 12345, 0.25}), "a pulse is under way");
  run(1);
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(injector.reading().last_id, 5U);
  EXPECT_EQ(pulses, 1);
  EXPECT_NEAR(injector.reading().pressure, 1000, 1e-9);  // as queried
  EXPECT_GT(injector.reading().volume, 0);
}

TEST_F(SerialInjectorTest, APulseWithoutReplyIsAFaultAndNeverSentAgain) {
  run(1);
  pulse_reply = "";
  injector.pulse({5, 10e3, 0.1});
  run(5);
  EXPECT_EQ(pulses, 1);
  EXPECT_NE(injector.fault().find("pulse 5: no good reply in time; it may have been done"), std::string::npos);
  EXPECT_NE(injector.pulse({6, 10e3, 0.1}), "");
  injector.reset();
  pulse_reply = "OK\r";
  EXPECT_EQ(injector.pulse({6, 10e3, 0.1}), "");
  run(1);
  EXPECT_EQ(pulses, 2);
  EXPECT_EQ(injector.reading().last_id, 6U);
}

TEST_F(SerialInjectorTest, ARefusedOrWronglyAnsweredPulseIsAFault) {
  run(1);
  pulse_reply = "ERR 3\r";
  injector.pulse({5, 10e3, 0.1});
  run(1);
  EXPECT_EQ(injector.fault(), "pulse 5: refused: ERR 3");
  injector.reset();
  pulse_reply = "OKAY\r";
  injector.pulse({6, 10e3, 0.1});
  run(1);
  EXPECT_NE(injector.fault().find("a wrong reply"), std::string::npos);
  EXPECT_EQ(pulses, 2);
  EXPECT_EQ(injector.reading().pulses, 0U);
}

TEST_F(SerialInjectorTest, ADeviceWithoutAStopSaysSo) {
  run(1);
  EXPECT_EQ(injector.stop(), "");
  injector.pulse({5, 10e3, 0.5});
  run(0.1);
  EXPECT_NE(injector.stop(), "");
  EXPECT_TRUE(injector.reading().busy);
}

TEST_F(SerialInjectorTest, ALateReplyIsNotTakenForTheNextOne) {
  run(1);
  pulse_reply = "";
  injector.pulse({5, 10e3, 0.1});
  run(0.55);
  injector.reset();
  injector.pulse({6, 10e3, 0.1});
  script.incoming = "OK\r";  // of pulse 5
  run(0.3);
  EXPECT_EQ(pulses, 2);
  run(1);
  EXPECT_NE(injector.fault().find("pulse 6"), std::string::npos);
  EXPECT_EQ(injector.reading().pulses, 0U);
}

TEST_F(SerialInjectorTest, ABalanceIsTriedAgainAndTheNewestWins) {
  deaf = true;
  run(0.7);
  injector.setBalance(2000);
  injector.setBalance(3000);
  run(1.3);
  EXPECT_EQ(script.sent.front(), "C10.0\r");
  EXPECT_EQ(script.sent.back(), "C30.0\r");
  EXPECT_EQ(std::count(script.sent.begin(), script.sent.end(), "C20.0\r"), 0);
  run(5);
  EXPECT_NE(injector.fault().find("balance pressure: no good reply"), std::string::npos);
}

TEST_F(SerialInjectorTest, APulseThatCannotBeSentSoonIsNeverSent) {
  run(1);
  script.sent.clear();
  for (int i = 0; i < 1000; ++i) {  // a device that does not stop talking
    script.incoming += "noise\r";
    injector.step(time += 0.01);
    if (i == 5) EXPECT_EQ(injector.pulse({5, 10e3, 0.1}), "");
  }
  EXPECT_NE(injector.fault().find("pulse 5 was not sent"), std::string::npos) << injector.fault();
  answered = script.sent.size();
  injector.reset();
  run(2);
  EXPECT_EQ(pulses, 0);
}

TEST_F(SerialInjectorTest, ABrokenLineEndsTheExchangeAndIsOpenedAgain) {
  run(1);
  deaf = true;
  injector.pulse({5, 10e3, 0.1});
  run(0.3);
  script.open = false;
  script.refusal = "unplugged";
  run(2);
  EXPECT_NE(injector.fault().find("pulse 5: the line broke"), std::string::npos);
  injector.reset();
  EXPECT_EQ(injector.fault(), "unplugged");
  deaf = false;
  script.refusal.clear();
  script.sent.clear();
  answered = 0;
  run(2);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(script.sent.front(), "C10.0\r");  // the device may have forgotten it
  EXPECT_EQ(std::count_if(script.sent.begin(), script.sent.end(), [](const auto& line) { return line[0] == 'P'; }), 0);
}

TEST_F(SerialInjectorTest, RefusesWhatTheDeviceCannotDo) {
  run(1);
  EXPECT_NE(injector.pulse({1, 60e3, 0.1}), "");
  EXPECT_NE(injector.pulse({1, 10e3, 0}), "");
  for (const double bad : {double(NAN), double(INFINITY), 1e300, -1e300}) {
    EXPECT_EQ(injector.pulse({1, bad, 0.1}).rfind("pulse pressure = ", 0), 0U) << bad;
    EXPECT_EQ(injector.pulse({1, 10e3, bad}).rfind("pulse duration = ", 0), 0U) << bad;
    EXPECT_EQ(injector.setBalance(bad).rfind("balance pressure = ", 0), 0U) << bad;
  }
  InjectorModelConfig fine = model;
  fine.limits.duration_range = {1e-4, 1};
  fine.limits.pressure_range = {-50e3, 50e3};
  WireScript other;
  SerialInjector device(std::make_unique<ScriptedWire>(other), testProtocol(), fine);
  for (int i = 0; i < 20; ++i) {
    device.step(0.05 * i);
    if (!other.sent.empty() && device.fault() != "") other.incoming = "OK\r";
  }
  EXPECT_EQ(device.pulse({1, 10e3, 0.4e-3}).rfind("in the digits of the device's line, pulse duration = 0 s", 0), 0U);
}

}  // namespace
}  // namespace microinjection
