// Commands of several lines: each with its reply.

#include "hardware/injector/dialogue_fixture.h"

namespace microinjection {
namespace {

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
  EXPECT_EQ(injector.fault(),
            "pulse 5: more than one reply; it may have been done, and is not sent again; the volume leaves it out");
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

}  // namespace
}  // namespace microinjection
