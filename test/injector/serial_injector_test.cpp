#include "injector/serial_injector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "injector/test_protocol.h"
#include "serial/scripted_wire.h"

namespace microinjection {
namespace {

class SerialInjectorTest : public ::testing::Test {
 protected:
  explicit SerialInjectorTest(const std::string& text = kTestProtocol)
      : injector{std::make_unique<ScriptedWire>(script), testProtocol(text), model} {}

  static InjectorModelConfig withBalance(double pressure) {
    InjectorModelConfig config;
    config.balance = pressure;
    return config;
  }

  /// Steps for a time (s) and answers each line but pulses as a device in order would.
  void run(double duration) {
    for (const double end = time + duration; time < end;) {
      injector.step(time += 0.01);
      if (script.sent.size() == answered) continue;
      const std::string line = script.sent.back();
      answered = script.sent.size();
      pulses += line[0] == 'P' ? 1 : 0;
      if (deaf) continue;
      if (line[0] == 'S' && stops_ignored-- > 0) continue;
      script.incoming = line[0] == '?' ? "=10.0\r" : line[0] == 'P' ? pulse_reply : "OK\r";
    }
  }

  InjectorModelConfig model = withBalance(1000);
  WireScript script;
  SerialInjector injector;
  double time = 0;
  std::size_t answered = 0;
  int pulses = 0;  // that the device has heard
  bool deaf = false;
  int stops_ignored = 0;
  std::string pulse_reply = "OK\r";
};

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

class StoppedSerialInjectorTest : public SerialInjectorTest {
 protected:
  StoppedSerialInjectorTest() : SerialInjectorTest(std::string(kTestProtocol) + kStop) {}
  long stops() const { return std::count(script.sent.begin(), script.sent.end(), "S\r"); }
};

TEST_F(StoppedSerialInjectorTest, AKilledNodesPulseIsStopped) { EXPECT_EQ(script.guarded_stop, "S\r"); }

TEST_F(StoppedSerialInjectorTest, APulseEndsWithTheProgram) {
  for (const bool pulse : {false, true}) {
    WireScript line;
    {
      SerialInjector ends(std::make_unique<ScriptedWire>(line), testProtocol(std::string(kTestProtocol) + kStop),
                          model);
      for (int i = 0; i < 300; ++i) {
        const std::size_t sent = line.sent.size();
        if (i == 100 && pulse) ends.pulse({5, 10e3, 30});
        ends.step(0.01 * i);
        if (line.sent.size() > sent) line.incoming = line.sent.back()[0] == '?' ? "=10.0\r" : "OK\r";
      }
      ASSERT_EQ(ends.reading().busy, pulse);
    }
    EXPECT_EQ(line.sent.back() == "S\r", pulse);
  }
}

TEST_F(StoppedSerialInjectorTest, ItsGuardSeesEveryStep) {
  for (int i = 0; i < 7; ++i) injector.step(0.01 * i);
  EXPECT_EQ(script.beats, 7);
}

TEST_F(StoppedSerialInjectorTest, APulseInWhichTheProgramStoodStillIsBrokenOff) {
  run(1);
  injector.pulse({5, 10e3, 30});
  run(1);
  ASSERT_TRUE(injector.reading().busy);
  script.guard.intervention = "the program stood still";
  injector.step(time += 60);  // longer than the pulse
  EXPECT_EQ(stops(), 0) << "the device's answer to the guard's is still to come";
  script.incoming = "OK\r";
  injector.step(time += 0.01);
  EXPECT_EQ(injector.reading().pulses, 0U);
  EXPECT_EQ(injector.fault(), "the pulse was broken off: the program stood still");
  EXPECT_NE(injector.pulse({6, 10e3, 0.1}), "");
  answered = script.sent.size();
  run(1);
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(stops(), 1) << "the guard's may have been lost";
  injector.reset();
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.pulse({6, 10e3, 0.1}), "");
  run(1);
  EXPECT_EQ(injector.reading().last_id, 6U);
}

TEST_F(StoppedSerialInjectorTest, TheReplyToTheGuardsStopIsNotTakenForAPulses) {
  run(1);
  pulse_reply = "";
  injector.pulse({5, 10e3, 30});
  run(0.1);
  script.guard.intervention = "the program stood still";
  script.incoming = "OK\r";
  injector.step(time += 1);
  run(0.1);
  EXPECT_EQ(injector.fault().rfind("pulse 5: the program stood still; it may have been done", 0), 0U);
  EXPECT_EQ(injector.reading().pulses, 0U);
  run(1);
  EXPECT_EQ(stops(), 1);
  EXPECT_EQ(pulses, 1);
}

TEST_F(StoppedSerialInjectorTest, APulseThatWaitsIsNotSentAfterTheProgramStoodStill) {
  run(1);
  injector.pulse({5, 10e3, 30});
  script.guard.intervention = "the program stood still";
  run(1);
  EXPECT_EQ(pulses, 0);
  EXPECT_EQ(injector.fault(), "the program stood still; pulse 5 was not sent");
}

TEST_F(StoppedSerialInjectorTest, WithoutAGuardThereIsNoPulse) {
  run(1);
  script.guard.missing = "it ended";
  run(1);
  EXPECT_EQ(injector.pulse({5, 10e3, 30}), "no stop guard: it ended");
  script.guard.missing.clear();
  run(0.01);
  EXPECT_EQ(injector.pulse({5, 10e3, 30}), "");
}

TEST_F(StoppedSerialInjectorTest, AStopEndsThePulseThatIsUnderWay) {
  run(1);
  injector.stop();
  run(1);
  EXPECT_EQ(stops(), 0) << "there was nothing to stop";
  injector.pulse({5, 10e3, 30});
  run(1);
  ASSERT_TRUE(injector.reading().busy);
  EXPECT_EQ(injector.stop(), "");
  EXPECT_TRUE(injector.reading().busy) << "until the device says so";
  run(0.1);
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(stops(), 1);
  EXPECT_EQ(injector.reading().pulses, 0U);
  EXPECT_EQ(injector.pulse({6, 10e3, 0.1}), "");
}

TEST_F(StoppedSerialInjectorTest, AStopTakesBackWhatWasNotSentAndIsRepeatedUntilItIsHeard) {
  run(1);
  injector.pulse({5, 10e3, 30});
  EXPECT_EQ(injector.stop(), "");
  run(1);
  EXPECT_EQ(pulses, 0);
  EXPECT_EQ(stops(), 0);
  injector.pulse({6, 10e3, 30});
  run(1);
  stops_ignored = 2;
  injector.stop();
  run(3);
  EXPECT_EQ(stops(), 3);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_FALSE(injector.reading().busy);
  injector.pulse({7, 10e3, 30});
  run(1);
  stops_ignored = 3;
  injector.stop();
  run(3);
  EXPECT_NE(injector.fault().find("stop: no good reply in time; the pulse may go on"), std::string::npos);
}

TEST_F(StoppedSerialInjectorTest, AStopIsSentForAPulseWithoutReply) {
  run(1);
  pulse_reply = "";
  injector.pulse({5, 10e3, 30});
  run(1);
  ASSERT_NE(injector.fault(), "");
  EXPECT_EQ(injector.stop(), "");
  run(1);
  EXPECT_EQ(stops(), 1);
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
  device.step(0);
  EXPECT_EQ(device.pulse({1, 10e3, 0.4e-3}).rfind("in the digits of the device's line, pulse duration = 0 s", 0), 0U);
}

/// A hundred thousand random, cut and damaged replies, late, twice and among good ones: no crash, no pressure that was
/// not sent, no pulse twice, and with a device in order again it works again.
TEST_F(SerialInjectorTest, MalformedRepliesDoNoHarm) {
  std::mt19937 random(3);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  std::uint64_t id = 0;
  int asked = 0, heard = 0, malformed = 0;
  while (malformed < 100000) {
    injector.step(time += 0.05);
    if (below(20) == 0 && injector.pulse({++id, 10e3, 0.01}).empty()) ++asked;
    if (below(20) == 0) injector.reset();
    if (below(5000) == 0) script.open = false;
    for (; answered < script.sent.size(); ++answered) heard += script.sent[answered][0] == 'P' ? 1 : 0;
    std::string reply = below(2) == 0 ? "OK\r" : "=12.5\r";
    if (below(3) == 0) reply.resize(below(reply.size()));
    if (below(3) == 0 && !reply.empty()) reply[below(reply.size())] = static_cast<char>(128 + below(128));
    if (below(10) == 0) reply.assign(below(600), static_cast<char>(below(128)));
    if (below(2) == 0) {
      script.incoming += reply;
      malformed += reply == "OK\r" || reply == "=12.5\r" ? 0 : 1;
    }
    const double pressure = injector.reading().pressure;
    ASSERT_TRUE(std::abs(pressure - 1250) < 1e-9 || (pressure >= 999 && pressure <= 10e3)) << pressure;
  }
  EXPECT_LE(heard, asked);
  EXPECT_LE(injector.reading().pulses, static_cast<unsigned>(heard));
  EXPECT_GT(injector.badReplies(), 10000U);
  script.incoming.clear();
  answered = script.sent.size();
  run(2);
  injector.reset();
  run(2);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.pulse({++id, 10e3, 0.01}), "");
  run(1);
  EXPECT_EQ(injector.reading().last_id, id);
}

}  // namespace
}  // namespace microinjection
