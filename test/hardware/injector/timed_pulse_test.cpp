// Pulses that are timed from here, by an output that is turned on and off.

#include "hardware/injector/dialogue_fixture.h"

namespace microinjection {
namespace {

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
  EXPECT_EQ(injector.fault().rfind("the pulse lasted longer than requested", 0), 0U);
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
  EXPECT_EQ(injector.fault(), "the device has not confirmed that its output is off");
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

constexpr char kLocked[] = "begin: [{send: U, expect: OK}, {send: V, expect: OK}]\n";

/// A device that does nothing before it is unlocked, at the start and each time that it was switched off.
class LockedTest : public DialogueTest {
 protected:
  LockedTest() : DialogueTest(std::string(kTimed) + kLocked) { lock(); }
  void lock() { answers = {{"U", "OK"}, {"V", "OK"}, {"N", "ERR locked"}, {"F", "ERR locked"}}; }
  void runLocked(double duration) {
    const long unlocked = count("V");
    for (const double end = time + duration; time < end;) {
      run(0.01);
      if (count("V") > unlocked) answers["N"] = answers["F"] = "OK";
    }
  }
};

TEST_F(LockedTest, HearsItsBeginBeforeTheFirstStop) {
  runLocked(1);
  EXPECT_EQ(said, (std::vector<std::string>{"U", "V", "F"}));
  EXPECT_EQ(injector.fault(), "");
  EXPECT_EQ(injector.pulse({5, 20e3, 0.5}), "");
  runLocked(1);
  EXPECT_EQ(injector.reading().pulses, 1U);
}

TEST_F(LockedTest, HearsItAgainWhenTheLineIsBackAlsoInAPulse) {
  runLocked(1);
  injector.pulse({5, 20e3, 30});
  runLocked(1);
  script.open = false;
  script.refusal = "unplugged";
  runLocked(2);
  lock();
  said.clear();
  script.refusal.clear();
  runLocked(2);
  EXPECT_EQ(said, (std::vector<std::string>{"U", "V", "F"}));
  EXPECT_FALSE(injector.reading().busy);
  EXPECT_EQ(injector.fault(), "the line broke during a pulse, which may go on");
}

TEST_F(LockedTest, ABeginWithoutReplyIsSaidAgain) {
  answers.erase("V");
  run(0.7);
  EXPECT_EQ(said, (std::vector<std::string>{"U", "V"}));
  answers["V"] = "OK";
  runLocked(1);
  EXPECT_EQ(said, (std::vector<std::string>{"U", "V", "U", "V", "F"}));
  EXPECT_EQ(injector.fault(), "");
}

TEST_F(LockedTest, ADeviceWithoutBeginIsStoppedAllTheSame) {
  answers = {{"N", "OK"}, {"F", "OK"}};
  run(10);
  EXPECT_EQ(count("U"), 3);
  EXPECT_EQ(said.back(), "F");
  EXPECT_EQ(injector.fault(), "");
}

}  // namespace
}  // namespace microinjection
