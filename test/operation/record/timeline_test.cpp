#include "operation/record/timeline.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

constexpr Nanoseconds kLong = 1000000;

TEST(Timeline, TellsWhatWasSaidLastAndHowLongThatHolds) {
  Timeline<int> line;
  EXPECT_EQ(line.at(10, kLong), nullptr);
  line.put(10, 1);
  line.put(20, 2);
  EXPECT_EQ(line.at(9, kLong), nullptr);
  EXPECT_EQ(*line.at(10, kLong)->value, 1);
  EXPECT_EQ(*line.at(19, kLong)->value, 1);
  EXPECT_EQ(line.at(19, 5), nullptr);
  EXPECT_EQ(*line.at(25, 5)->value, 2);
}

TEST(Timeline, TheOrderIsThatOfTheStamps) {
  Timeline<int> line;
  line.put(20, 2);
  line.put(10, 1);
  EXPECT_EQ(*line.at(10, kLong)->value, 1);
  EXPECT_EQ(*line.at(20, kLong)->value, 2);
  line.put(20, 3);
  EXPECT_EQ(*line.at(20, kLong)->value, 3) << "of two with the same stamp the later one";
}

TEST(Timeline, AStampAheadDoesNotHideWhatComesAfter) {
  Timeline<int> line;
  line.put(10, 1);
  line.put(4000000000000000000, 9);
  line.put(20, 2);
  EXPECT_EQ(*line.at(30, kLong)->value, 2);
  line.discardBefore(30);
  line.put(40, 4);
  EXPECT_EQ(*line.at(50, kLong)->value, 4);
}

TEST(Timeline, WhatIsOlderThanWhatWasForgottenIsIgnored) {
  Timeline<int> line;
  for (int i = 1; i <= 3; ++i) line.put(10 * i, i);
  line.discardBefore(25);
  line.put(15, 9);
  EXPECT_EQ(line.at(19, kLong), nullptr);
  EXPECT_EQ(*line.at(25, kLong)->value, 2);
  line.withdraw();
  EXPECT_EQ(line.at(35, kLong), nullptr) << "the last that counted is withdrawn";
}

TEST(Timeline, StampsThatAreAllAheadDoNotFillTheMemory) {
  Timeline<int> line;
  for (std::size_t i = 0; i < Timeline<int>::kCapacity + 1000; ++i) line.put(1000000 + static_cast<Nanoseconds>(i), 9);
  EXPECT_EQ(line.size(), Timeline<int>::kCapacity);
  line.put(10, 1);
  EXPECT_EQ(*line.at(20, kLong)->value, 1);
  EXPECT_EQ(line.size(), Timeline<int>::kCapacity);
}

TEST(Timeline, AWithdrawalCountsFromWhatArrivedLast) {
  Timeline<int> line;
  line.put(10, 1);
  line.put(30, 3);
  line.put(20, 2);
  line.withdraw();
  EXPECT_EQ(*line.at(20, kLong)->value, 2);
  EXPECT_EQ(line.at(25, kLong), nullptr);
  EXPECT_EQ(*line.at(30, kLong)->value, 3);
}

TEST(Timeline, WhatIsWithdrawnDoesNotHoldUntilTheNext) {
  Timeline<int> line;
  line.withdraw();
  line.put(10, 1);
  line.withdraw();
  line.withdraw();
  line.put(20, 2);
  EXPECT_EQ(*line.at(10, kLong)->value, 1);
  EXPECT_EQ(line.at(15, kLong), nullptr);
  EXPECT_EQ(*line.at(20, kLong)->value, 2);
}

TEST(Timeline, FindsWhatComesAfter) {
  Timeline<int> line;
  for (int i = 1; i <= 5; ++i) line.put(10 * i, i);
  EXPECT_EQ(line.firstAfter(10, [](int i) { return i % 2 == 1; })->stamp, 30);
  EXPECT_EQ(line.firstAfter(30, [](int i) { return i < 3; }), nullptr);
}

TEST(Timeline, ForgetsOnlyWhatNobodyAsksForAgain) {
  Timeline<int> line;
  for (int i = 1; i <= 5; ++i) line.put(10 * i, i);
  line.discardBefore(35);
  EXPECT_EQ(line.at(29, kLong), nullptr);
  EXPECT_EQ(*line.at(35, kLong)->value, 3);
  EXPECT_EQ(*line.at(50, kLong)->value, 5);
}

}  // namespace
}  // namespace microinjection
