// A pulse that is ended: at a word, with the program, by the guard.

#include "hardware/injector/serial_injector_fixture.h"

namespace microinjection {
namespace {

TEST_F(StoppedSerialInjectorTest, AKilledNodesPulseIsStopped) { EXPECT_EQ(script.guarded_stop, "S\r"); }

/// The device answers each line; `pulse`: 30 s begin after 1 s.
bool isBusyAfterThreeSeconds(SerialInjector& injector, WireScript& line, bool pulse) {
  for (int i = 0; i < 300; ++i) {
    const std::size_t sent = line.sent.size();
    if (i == 100 && pulse) injector.pulse({5, 10e3, 30});
    injector.step(0.01 * i);
    if (line.sent.size() > sent) line.incoming = line.sent.back()[0] == '?' ? "=10.0\r" : "OK\r";
  }
  return injector.reading().busy;
}

TEST_F(StoppedSerialInjectorTest, APulseEndsWithTheProgram) {
  for (const bool pulse : {false, true}) {
    WireScript line;
    {
      SerialInjector ends(std::make_unique<ScriptedWire>(line), testProtocol(std::string(kTestProtocol) + kStop),
                          model);
      ASSERT_EQ(isBusyAfterThreeSeconds(ends, line, pulse), pulse);
    }
    EXPECT_EQ(line.sent.back() == "S\r", pulse);
  }
}

TEST_F(StoppedSerialInjectorTest, AStopThatMayComeTooEarlyIsRepeatedByTheGuardBehindTheProgramsEnd) {
  for (const bool pulse : {false, true}) {
    WireScript line;
    {
      SerialInjector ends(
          std::make_unique<ScriptedWire>(line),
          testProtocol(std::string(kTestProtocol) + "stop: [{send: 'S{count}', expect: OK}]\nstop_apart: 1"), model);
      ASSERT_EQ(isBusyAfterThreeSeconds(ends, line, pulse), pulse);
      EXPECT_EQ(line.guarded_stop, "S0\r");
      EXPECT_EQ(line.stops_apart, 1);
    }
    EXPECT_EQ(line.left_to_guard, pulse);
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

}  // namespace
}  // namespace microinjection
