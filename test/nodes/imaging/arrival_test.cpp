#include "nodes/imaging/arrival.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace microinjection {
namespace {

constexpr double kTimeout = 500;  // s, in which no machine stands still

/// ROS time stands still until it is set.
class ArrivalTest : public testing::Test {
 protected:
  ArrivalTest() {
    ros::Time::init();
    ros::Time::setNow(ros::Time(100000));
  }
};

TEST_F(ArrivalTest, WhatNeverCameIsOld) { EXPECT_TRUE(Arrival().isOld(kTimeout)); }

/// Not twice the time-out, which an age at its arrival and another one since then could add up to.
TEST_F(ArrivalTest, TheAgeCountsFromTheStamp) {
  const Arrival image(ros::Time(99700));
  EXPECT_FALSE(image.isOld(kTimeout));
  ros::Time::setNow(ros::Time(100100));
  EXPECT_FALSE(image.isOld(kTimeout));
  ros::Time::setNow(ros::Time(100300));
  EXPECT_TRUE(image.isOld(kTimeout));
}

TEST_F(ArrivalTest, AClockThatWasSetBackKeepsNothingFresh) {
  const Arrival image(ros::Time(100000));
  ros::Time::setNow(ros::Time(99000));
  EXPECT_TRUE(image.isOld(kTimeout));
}

TEST_F(ArrivalTest, AClockThatStandsStillKeepsNothingFresh) {
  const Arrival image(ros::Time(100000));
  constexpr double kShort = 1e-3;  // s
  std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_TRUE(image.isOld(kShort));
}

TEST_F(ArrivalTest, ClocksOfTwoHostsMayBeApartByMilliseconds) {
  EXPECT_FALSE(Arrival(ros::Time(100000.02)).isOld(kTimeout));
  EXPECT_TRUE(Arrival(ros::Time(100000.2)).isOld(kTimeout));
}

}  // namespace
}  // namespace microinjection
