// A pressure that was asked for by a query is shown only while the device does what it did then.

#include "hardware/injector/dialogue_fixture.h"

namespace microinjection {
namespace {

constexpr char kQuery[] = "query: {send: '?', expect: '=([0-9.]+)'}\nquery_period: 0.5\npressure_unit: 100\n";
constexpr char kTimedQuery[] = R"yaml(
timed: true
pulse: [{send: "N{pressure_hPa:1}", expect: OK}]
balance: [{send: "C{pressure_hPa:1}", expect: OK}]
stop: [{send: "F", expect: OK}]
refuse: "ERR.*"
terminator: CRLF
)yaml";

class QueriedPressureTest : public DialogueTest {
 protected:
  QueriedPressureTest() : QueriedPressureTest(kSetSetTrigger) {}
  explicit QueriedPressureTest(const std::string& text) : DialogueTest(text + kQuery) {
    answers["?"] = "=9.9";  // 990 Pa, its balance pressure as it measures it
    answers["C20.0"] = "OK";
  }
  double pressure() const { return injector.reading().pressure; }
};

TEST_F(QueriedPressureTest, IsThatOfTheDeviceAtRest) {
  run(1);
  EXPECT_NEAR(pressure(), 990, 1e-9);
}

TEST_F(QueriedPressureTest, OfTheBalanceIsNotShownInAPulseNorThatOfThePulseAfterIt) {
  run(1);
  injector.pulse({5, 12300, 0.7});
  run(0.1);
  ASSERT_TRUE(injector.reading().busy);
  EXPECT_NEAR(pressure(), 12300, 1) << "before the next query";
  answers["?"] = "=122.0";
  run(0.5);
  ASSERT_TRUE(injector.reading().busy);
  EXPECT_NEAR(pressure(), 12200, 1) << "as queried in the pulse";
  while (injector.reading().busy) run(0.01);
  answers["?"] = "=9.9";
  run(0.06);
  EXPECT_NEAR(pressure(), 1000, 1) << "the pulse is over";
  run(0.6);
  EXPECT_NEAR(pressure(), 990, 1e-9);
}

TEST_F(QueriedPressureTest, OfThePulseIsNotShownAfterAStop) {
  run(1);
  injector.pulse({5, 12300, 30});
  answers["?"] = "=122.0";
  run(1);
  ASSERT_NEAR(pressure(), 12200, 1);
  injector.stop();
  answers["?"] = "=9.9";
  run(0.1);
  EXPECT_NEAR(pressure(), 1000, 1);
}

TEST_F(QueriedPressureTest, OfTheBalanceBeforeIsNotShownAfterANewOne) {
  run(1);
  answers["C"] = "C=20.0";
  injector.setBalance(2000);
  run(0.06);
  ASSERT_EQ(injector.fault(), "");
  EXPECT_NEAR(pressure(), 2000, 5);
}

/// The answer to a query that was on its way when the pulse ended is of before.
TEST_F(QueriedPressureTest, ThatWasAskedForBeforeAChangeIsNotShownAfterIt) {
  run(1);
  injector.pulse({5, 12300, 0.7});
  answers.erase("?");
  const long asked = count("?");
  while (count("?") == asked) run(0.01);
  while (injector.reading().busy) run(0.01);
  script.incoming = "=122.0\r\n";
  run(0.1);
  EXPECT_NEAR(pressure(), 1000, 1);
}

TEST_F(QueriedPressureTest, OfTheBalanceIsNotShownAfterAPulseThatMayBeUnderWay) {
  run(1);
  answers.erase("G");
  injector.pulse({5, 12300, 30});
  while (injector.fault().empty()) run(0.01);
  EXPECT_NEAR(pressure(), 1000, 1);
}

TEST_F(QueriedPressureTest, OfTheBalanceBeforeIsNotShownAfterANewOneWithoutAReply) {
  run(1);
  answers.erase("C20.0");
  answers.erase("C");
  injector.setBalance(2000);
  while (injector.fault().empty()) run(0.01);
  EXPECT_NEAR(pressure(), 1000, 1);
}

TEST_F(QueriedPressureTest, OfThePulseIsNotShownAfterTheGuardHasEndedIt) {
  run(1);
  injector.pulse({5, 12300, 30});
  answers["?"] = "=122.0";
  run(1);
  ASSERT_NEAR(pressure(), 12200, 1);
  script.guard.intervention = "the program stood still";
  run(0.01);
  EXPECT_LT(pressure(), 5000) << "it falls to the balance pressure";
}

TEST_F(QueriedPressureTest, OfAPulseThatMayHaveBeenDoneIsNotShownAfterItsTime) {
  run(1);
  answers.erase("G");
  answers["?"] = "=122.0";
  injector.pulse({5, 12300, 3});
  while (injector.fault().empty()) run(0.01);
  run(1.5);
  ASSERT_NEAR(pressure(), 12200, 1);
  for (int i = 0; i < 400 && pressure() > 12000; ++i) run(0.01);
  EXPECT_NEAR(pressure(), 1000, 1);
}

TEST_F(QueriedPressureTest, OfBeforeAStopWithoutReplyIsNotShownAfterIt) {
  run(1);
  injector.pulse({5, 12300, 30});
  answers["?"] = "=122.0";
  run(1);
  ASSERT_NEAR(pressure(), 12200, 1);
  answers.erase("S");
  injector.stop();
  while (injector.fault().empty()) run(0.01);
  EXPECT_NEAR(pressure(), 12300, 1) << "the pulse may go on";
}

class TimedQueryTest : public QueriedPressureTest {
 protected:
  TimedQueryTest() : QueriedPressureTest(kTimedQuery) { answers["N"] = answers["F"] = "OK"; }
};

/// Nothing is asked during a pulse that is timed from here.
TEST_F(TimedQueryTest, OfTheBalanceIsNotShownInATimedPulse) {
  run(1);
  ASSERT_NEAR(pressure(), 990, 1e-9);
  injector.pulse({5, 12300, 2});
  run(1);
  ASSERT_TRUE(injector.reading().busy);
  EXPECT_NEAR(pressure(), 12300, 1);
  run(1.3);
  ASSERT_EQ(injector.reading().pulses, 1U);
  EXPECT_NEAR(pressure(), 990, 1e-9);
}

/// A device that is asked whether it is there, and set again when it may have been reset.
class SilentQueryTest : public DialogueTest {
 protected:
  static constexpr char kText[] = R"yaml(
pulse: [{send: "P{pressure_hPa:1} {duration_ms:0}", expect: OK}]
balance: [{send: "C{pressure_hPa:1}", expect: OK, timeout: 0.2}]
query: {send: "?{count}", expect: "heard (.*)", confirm: line, timeout: 0.2}
query_period: 0.3
terminator: CRLF
quiet: 0.05
refuse: "ERR.*"
)yaml";
  SilentQueryTest() : DialogueTest(kText) { answers["?"] = ""; }
};

TEST_F(SilentQueryTest, ADeviceThatNeverAnswersAQueryIsGivenUpThoughItTakesItsBalancePressure) {
  answers.erase("?");
  run(5);
  EXPECT_GT(count("C10.0"), 3);
  EXPECT_EQ(injector.fault(), "query: no good reply in time");
  EXPECT_NE(injector.pulse({5, 12300, 0.25}), "");
  bool told = true;
  for (int i = 0; i < 200; ++i) {
    run(0.01);
    told = told && !injector.fault().empty();
  }
  EXPECT_TRUE(told) << "also when it has taken the balance pressure again";
}

TEST_F(SilentQueryTest, OneThatAnswersAgainIsNoFaultAnyMore) {
  answers.erase("?");
  run(5);
  ASSERT_NE(injector.fault(), "");
  for (char count = '0'; count <= '9'; ++count) answers[std::string("?") + count] = std::string("heard ?") + count;
  for (const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"; *letters != 0; ++letters) {
    answers[std::string("?") + *letters] = std::string("heard ?") + *letters;
  }
  run(2);
  EXPECT_EQ(injector.fault(), "");
}

}  // namespace
}  // namespace microinjection
