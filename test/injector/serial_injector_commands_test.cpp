// Commands of several lines, and pulses that are timed from here.

#include <map>
#include <vector>

#include "injector/serial_injector_fixture.h"

namespace microinjection {
namespace {

constexpr char kSetSetTrigger[] = R"yaml(
pulse:
  - {send: "P{pressure_hPa:1}", expect: OK}
  - {send: "T{duration_ms:0}", expect: OK}
  - {send: "G", expect: "OK|GONE"}
balance: [{send: "C{pressure_hPa:1}", expect: OK}, {send: "C", expect: "C=([0-9.]+)", confirm: pressure_hPa}]
stop: [{send: S, expect: OK}]
refuse: "ERR.*"
terminator: CRLF
)yaml";

class DialogueTest : public ::testing::Test {
 protected:
  explicit DialogueTest(const std::string& text = kSetSetTrigger)
      : injector{std::make_unique<ScriptedWire>(script), testProtocol(text), model} {
    answers = {{"P", "OK"}, {"T", "OK"}, {"G", "OK"}, {"C10.0", "OK"}, {"C", "C=10.0"}, {"S", "OK"}};
  }

  static InjectorModelConfig withBalance(double pressure) {
    InjectorModelConfig config;
    config.balance = pressure;
    return config;
  }

  /// The answer to a line is that of its whole, or of its letter; none: it is not answered.
  void run(double duration) {
    for (const double end = time + duration; time < end;) {
      injector.step(time += 0.01);
      for (; answered < script.sent.size(); ++answered) {
        std::string line = script.sent[answered];
        ASSERT_EQ(line.substr(line.size() - 2), "\r\n");
        line.resize(line.size() - 2);
        said.push_back(line);
        const std::string key = answers.count(line) ? line : line.substr(0, 1);
        if (answers.count(key)) script.incoming += answers[key] + "\r\n";
      }
    }
  }

  long count(const std::string& line) const { return std::count(said.begin(), said.end(), line); }

  InjectorModelConfig model = withBalance(1000);
  WireScript script;
  SerialInjector injector;
  std::map<std::string, std::string> answers;
  std::vector<std::string> said;
  std::size_t answered = 0;
  double time = 0;
};

TEST_F(DialogueTest, EachLineWaitsForItsReply) {
  run(1);
  EXPECT_EQ(said, (std::vector<std::string>{"C10.0", "C"}));
  said.clear();
  injector.pulse({5, 12300, 0.25});
  run(0.05);
  EXPECT_EQ(said, (std::vector<std::string>{"P123.0", "T250", "G"}));
  run(1);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.reading().last_id, 5U);
}

TEST_F(DialogueTest, OnlyTheTriggersAcceptanceIsAPulseUnderWay) {
  run(1);
  answers.erase("G");
  injector.pulse({5, 12300, 0.25});
  run(0.3);
  EXPECT_TRUE(injector.reading().busy);
  EXPECT_NEAR(injector.reading().pressure, 1000, 1e-6) << "nothing flows that was only set up";
  script.incoming = "GONE\r\n";
  run(0.1);
  EXPECT_NEAR(injector.reading().pressure, 12300, 1);
  run(0.1);
  EXPECT_EQ(injector.reading().pulses, 0U);
  run(0.1);
  EXPECT_EQ(injector.reading().pulses, 1U);
}

TEST_F(DialogueTest, APulseIsNotTriggeredWhenItsSetUpIsRefused) {
  run(1);
  for (const char* refused : {"P", "T"}) {
    answers[refused] = "ERR 7";
    ASSERT_EQ(injector.pulse({5, 12300, 0.25}), "");
    run(1);
    EXPECT_EQ(injector.fault(), "pulse 5: refused: ERR 7; it was not triggered");
    EXPECT_EQ(count("G"), 0);
    EXPECT_FALSE(injector.reading().busy);
    EXPECT_EQ(injector.reading().last_id, 0U);
    EXPECT_NEAR(injector.reading().pressure, 1000, 1e-6);
    answers[refused] = "OK";
    injector.reset();
  }
}

TEST_F(DialogueTest, ARefusedTriggerIsNoPulse) {
  run(1);
  answers["G"] = "ERR 9";
  injector.pulse({5, 12300, 0.25});
  run(1);
  EXPECT_EQ(injector.fault(), "pulse 5: refused: ERR 9");
  EXPECT_EQ(injector.reading().pulses, 0U);
  EXPECT_NEAR(injector.reading().pressure, 1000, 1e-6);
}

TEST_F(DialogueTest, ASetUpWithoutReplyIsNotTriggered) {
  run(1);
  answers.erase("T");
  injector.pulse({5, 12300, 0.25});
  run(2);
  EXPECT_EQ(injector.fault(), "pulse 5: no good reply in time; it was not triggered");
  EXPECT_EQ(count("G"), 0);
}

TEST_F(DialogueTest, AStopTakesBackAPulseThatIsOnlySetUp) {
  run(1);
  answers.erase("T");
  injector.pulse({5, 12300, 0.25});
  run(0.1);
  ASSERT_EQ(count("T250"), 1);
  EXPECT_EQ(injector.stop(), "");
  script.incoming = "OK\r\n";
  run(1);
  EXPECT_EQ(count("G"), 0);
  EXPECT_EQ(count("S"), 0) << "nothing was triggered";
  EXPECT_EQ(injector.fault(), "");
  answers["T"] = "OK";
  EXPECT_EQ(injector.pulse({6, 12300, 0.25}), "");
  run(1);
  EXPECT_EQ(injector.reading().last_id, 6U);
}

TEST_F(DialogueTest, AStopGoesBetweenTheLinesOfABalance) {
  run(1);
  injector.pulse({5, 12300, 30});
  run(1);
  ASSERT_TRUE(injector.reading().busy);
  answers.erase("C20.0");
  answers.erase("C");
  said.clear();
  injector.setBalance(2000);
  run(0.1);
  injector.stop();
  script.incoming = "OK\r\n";
  answers["C"] = "C=20.0";
  answers["C20.0"] = "OK";
  run(0.2);
  EXPECT_EQ(said, (std::vector<std::string>{"C20.0", "S", "C20.0", "C"}));
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_NEAR(injector.reading().pressure, 2000, 1);
}

TEST_F(DialogueTest, WhatMayBeUnderWayIsAFaultAfterAResetToo) {
  run(1);
  answers.erase("G");
  injector.pulse({5, 12300, 3});
  run(1);
  injector.reset();
  EXPECT_EQ(injector.fault(), "a pulse may be under way");
  EXPECT_NE(injector.pulse({6, 12300, 0.1}), "");
  run(1.9);
  EXPECT_EQ(injector.fault(), "a pulse may be under way");
  run(0.3);
  EXPECT_EQ(injector.fault(), "");
  injector.pulse({7, 12300, 30});
  run(1);
  injector.reset();
  EXPECT_EQ(injector.stop(), "");
  run(0.5);
  EXPECT_EQ(count("S"), 1);
  EXPECT_EQ(injector.fault(), "") << "the device has accepted a stop";
}

TEST_F(DialogueTest, ABalanceThatReadsBackOtherwiseIsNotTold) {
  run(1);
  answers["C20.0"] = "OK";
  injector.setBalance(2000);  // and it reads back 10.0
  run(5);
  EXPECT_EQ(count("C20.0"), 3);
  EXPECT_EQ(injector.fault(), "balance pressure: it reads back 10.0 instead of 20");
  EXPECT_NEAR(injector.reading().pressure, 1000, 1);
  injector.reset();
  EXPECT_EQ(injector.fault(), "the device has not accepted the balance pressure");
  answers["C"] = "C=20.0";
  run(1);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_NEAR(injector.reading().pressure, 2000, 1);
}

/// Of two replies at once nobody knows which is the right one.
TEST_F(DialogueTest, TwoRepliesAreNone) {
  run(1);
  answers["G"] = "OK\r\nERR 9";
  injector.pulse({5, 12300, 0.25});
  run(1);
  EXPECT_EQ(injector.fault(), "pulse 5: more than one reply; it may have been done, and is not sent again");
  EXPECT_EQ(injector.reading().pulses, 0U);
}

class EchoTest : public DialogueTest {
 protected:
  EchoTest() : DialogueTest(std::string(kSetSetTrigger) + "echo: true\nbegin: [{send: AB, expect: '.*'}]\n") {}
};

TEST_F(EchoTest, ALineThatIsRepeatedIsNoReply) {
  answers = {{"A", "AB\r\nERR 1"}, {"C10.0", "C10.0\r\nOK"}, {"C", "\r\nC=10.0"}, {"P", "P123.0\r\nOK"},
             {"T", "OK"},          {"G", "G\r\nERR 9"}};
  run(1);
  EXPECT_EQ(injector.fault(), "");
  injector.pulse({5, 12300, 0.25});
  run(1);
  EXPECT_EQ(said, (std::vector<std::string>{"AB", "C10.0", "C", "P123.0", "T250", "G"}));
  EXPECT_EQ(injector.fault(), "pulse 5: refused: ERR 9");
}

constexpr char kTimed[] = R"yaml(
timed: true
pulse_pressure: 20.0e3
pulse: [{send: "N", expect: OK}]
stop: [{send: "F", expect: OK}]
refuse: "ERR.*"
terminator: CRLF
)yaml";

class TimedTest : public DialogueTest {
 protected:
  TimedTest() : DialogueTest(kTimed) { answers = {{"N", "OK"}, {"F", "OK"}}; }
};

TEST_F(TimedTest, TheOutputIsTurnedOffAtTheStartAndAtThePulsesEnd) {
  run(1);
  EXPECT_EQ(said, (std::vector<std::string>{"F"}));
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.setBalance(500).rfind("the device's balance pressure is set by hand", 0), 0U);
  EXPECT_EQ(injector.pulse({5, 10e3, 0.5}), "pulse pressure = 10000 Pa: set by hand at the device, must be 20000 Pa");
  EXPECT_EQ(injector.pulse({5, 20e3, 0.5}), "");
  run(0.45);
  EXPECT_EQ(said.back(), "N");
  EXPECT_TRUE(injector.reading().busy);
  run(0.1);
  EXPECT_EQ(said, (std::vector<std::string>{"F", "N", "F"}));
  EXPECT_EQ(injector.reading().last_id, 5U);
  EXPECT_FALSE(injector.reading().busy);
}

TEST_F(TimedTest, APulseWhoseEndIsNotHeardIsNotDoneAndItsEndIsSentForEver) {
  run(1);
  injector.pulse({5, 20e3, 0.5});
  run(0.2);
  answers.erase("F");
  run(10);
  EXPECT_TRUE(injector.reading().busy);
  EXPECT_EQ(injector.reading().pulses, 0U);
  EXPECT_EQ(injector.fault(), "stop: no good reply in time; the pulse may go on");
  EXPECT_GT(count("F"), 6);
  EXPECT_NEAR(injector.reading().pressure, 20e3, 1);
  injector.reset();
  EXPECT_NE(injector.pulse({6, 20e3, 0.5}), "");
  answers["F"] = "OK";
  run(3);
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(injector.reading().pulses, 0U);
}

TEST_F(TimedTest, APulseThatLastedLongerIsNotDone) {
  run(1);
  injector.pulse({5, 20e3, 0.5});
  run(0.2);
  answers["F"] = "WHAT";
  run(0.4);
  answers["F"] = "OK";
  run(1);
  EXPECT_EQ(injector.fault().rfind("the pulse lasted longer than was asked for", 0), 0U);
  EXPECT_EQ(injector.reading().pulses, 0U);
  EXPECT_FALSE(injector.reading().busy);
}

TEST_F(TimedTest, ATriggerWithoutReplyIsTurnedOffAtOnce) {
  run(1);
  answers.erase("N");
  injector.pulse({5, 20e3, 30});
  run(1);
  EXPECT_EQ(said, (std::vector<std::string>{"F", "N", "F"}));
  EXPECT_NE(injector.fault().find("it may have been done"), std::string::npos);
}

TEST_F(TimedTest, AnOutputIsTurnedOffWhenTheLineIsBack) {
  run(1);
  injector.pulse({5, 20e3, 30});
  run(1);
  script.open = false;
  script.refusal = "unplugged";
  run(2);
  EXPECT_TRUE(injector.reading().busy) << "nobody has ended it";
  EXPECT_EQ(injector.fault(), "the line broke during a pulse, which may go on");
  script.refusal.clear();
  run(2);
  EXPECT_EQ(said, (std::vector<std::string>{"F", "N", "F"}));
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(injector.reading().pulses, 0U);
}

TEST_F(TimedTest, NoPulseBeforeTheOutputIsKnownToBeOff) {
  answers.erase("F");
  run(0.1);
  EXPECT_NE(injector.pulse({5, 20e3, 0.5}), "");
  run(3);
  injector.reset();
  EXPECT_EQ(injector.fault(), "the device has not said that its output is off");
  answers["F"] = "OK";
  run(3);
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.pulse({5, 20e3, 0.5}), "");
}

TEST_F(TimedTest, AStopEndsItBeforeItsTimeAndItDoesNotCount) {
  run(1);
  injector.pulse({5, 20e3, 30});
  run(1);
  EXPECT_EQ(injector.stop(), "");
  run(0.1);
  EXPECT_EQ(said.back(), "F");
  EXPECT_EQ(injector.reading().pulses, 0U);
  EXPECT_EQ(injector.fault(), "");
}

}  // namespace
}  // namespace microinjection
