#include "nodes/runtime/sole_sender.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

ros::Time at(double seconds) { return ros::Time(100 + seconds); }

TEST(SoleSender, NamesTwoThatSendAtOnce) {
  SoleSender senders;
  senders.receive("/sensor", at(0));
  EXPECT_EQ(senders.rivals(at(0)), "");
  senders.receive("/stranger", at(0.1));
  EXPECT_EQ(senders.rivals(at(0.1)), "/sensor and /stranger");
  senders.receive("/sensor", at(0.2));
  EXPECT_EQ(senders.rivals(at(0.2)), "/sensor and /stranger");
}

TEST(SoleSender, OneThatHasStoppedIsNoRival) {
  SoleSender senders;
  senders.receive("/stranger", at(0));
  for (double t = 0.001; t < 1; t += 0.001) senders.receive("/sensor", at(t));
  EXPECT_EQ(senders.rivals(at(1)), "");
}

TEST(SoleSender, ASuccessorTakesOver) {
  SoleSender senders;
  senders.receive("/old", at(0));
  senders.receive("/new", at(0.6));
  EXPECT_EQ(senders.rivals(at(0.6)), "");
}

TEST(SoleSender, OneThatTellsChangesOnlyIsARivalForLongerWhileItIsThere) {
  SoleSender senders;
  senders.receive("/pedal", at(0));
  EXPECT_EQ(senders.rivals(at(100), true), "") << "one that has said nothing yet is none";
  senders.receive("/stranger", at(100));
  EXPECT_EQ(senders.rivals(at(102.9), true), "/pedal and /stranger");
  EXPECT_EQ(senders.rivals(at(102.9), false), "") << "one of them is gone";
  EXPECT_EQ(senders.rivals(at(103.1), true), "") << "it may have been killed, which no subscriber is told";
}

TEST(SoleSender, TwoThatTakeTurnsSlowlyAreRivals) {
  SoleSender senders;
  for (int second = 0; second < 2; ++second) {
    senders.receive("/camera", at(second));
    senders.receive("/stranger", at(second + 0.5));
  }
  for (int second = 2; second < 9; ++second) {
    senders.receive("/camera", at(second));
    EXPECT_EQ(senders.rivals(at(second)), "/camera and /stranger");
    senders.receive("/stranger", at(second + 0.5));
    EXPECT_EQ(senders.rivals(at(second + 0.5)), "/camera and /stranger");
  }
  EXPECT_EQ(senders.rivals(at(20)), "");
}

TEST(SoleSender, RefusesWhatComesFromTwo) {
  SoleSender senders;
  EXPECT_EQ(senders.refusalOf("/camera", at(0)), "");
  EXPECT_EQ(senders.refusalOf("/stranger", at(0.1)),
            "it is sent by two nodes, /camera and /stranger: none counts until one has stopped");
}

TEST(SoleSender, OneMessageOfAStrangerIsEnough) {
  SoleSender senders;
  for (double t = 0; t < 1; t += 0.001) senders.receive("/sensor", at(t));
  senders.receive("/stranger", at(1));
  for (double t = 1.001; t < 1.4; t += 0.001) {
    senders.receive("/sensor", at(t));
    EXPECT_NE(senders.rivals(at(t)), "");
  }
  EXPECT_EQ(senders.rivals(at(1.6)), "");
}

}  // namespace
}  // namespace microinjection
