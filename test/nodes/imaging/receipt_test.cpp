#include "nodes/runtime/receipt.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

constexpr double kTimeout = 500;  // s

class ReceiptTest : public testing::Test {
 protected:
  Receipt receive(double stamp) const { return {ros::Time(stamp), steady_}; }
  bool isOld(const Receipt& receipt) const { return receipt.isOld(kTimeout, now_, steady_); }

  ros::Time now_{100000.0};
  ros::SteadyTime steady_{700.0};
};

TEST_F(ReceiptTest, WhatNeverCameIsOld) { EXPECT_TRUE(isOld(Receipt())); }

/// Not twice the time-out, which an age at its arrival and another one since then could add up to.
TEST_F(ReceiptTest, TheAgeCountsFromTheStamp) {
  const Receipt image = receive(99700);
  EXPECT_FALSE(isOld(image));
  now_ = ros::Time(100100);
  EXPECT_FALSE(isOld(image));
  now_ = ros::Time(100300);
  EXPECT_TRUE(isOld(image));
}

TEST_F(ReceiptTest, AClockThatWasSetBackKeepsNothingFresh) {
  const Receipt image = receive(100000);
  now_ = ros::Time(99000);
  EXPECT_TRUE(isOld(image));
}

TEST_F(ReceiptTest, AClockThatStandsStillKeepsNothingFresh) {
  const Receipt image = receive(100000);
  steady_ += ros::WallDuration(400);
  EXPECT_FALSE(isOld(image));
  steady_ += ros::WallDuration(200);
  EXPECT_TRUE(isOld(image));
}

TEST_F(ReceiptTest, ClocksOfTwoHostsMayBeApartByMilliseconds) {
  EXPECT_FALSE(isOld(receive(100000.02)));
  EXPECT_TRUE(isOld(receive(100000.2)));
}

}  // namespace
}  // namespace microinjection
