#include "operation/teleoperation/goal_hand.h"

#include <gtest/gtest.h>

#include <cmath>

namespace microinjection {
namespace {

constexpr double kPeriod = 1e-3;  // s

GoalHandConfig goalHandConfig() { return {0.02, 5e-3, 0.5}; }  // m/s, m, s

/// Steps of kPeriod for a time (s).
void rest(GoalHand& hand, double time) {
  for (int i = 0; i < std::lround(time / kPeriod); ++i) hand.step(kPeriod);
}

TEST(GoalHand, GoesToItsGoalAtTheLimitedSpeedAndStays) {
  GoalHand hand(goalHandConfig());
  hand.stay();
  hand.moveTo({0.003, 0.004, 0});  // 5 mm: a quarter of a second
  Eigen::Vector3d before = hand.position();
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector3d after = hand.step(kPeriod);
    EXPECT_LE((after - before).norm(), 0.02 * kPeriod * (1 + 1e-12));
    if (i == 124) EXPECT_NEAR((after - Eigen::Vector3d(0.0015, 0.002, 0)).norm(), 0, 1e-12);
    before = after;
  }
  EXPECT_EQ(hand.position(), Eigen::Vector3d(0.003, 0.004, 0));
}

TEST(GoalHand, StepsAddUpButNotBeyondTheLead) {
  GoalHand hand(goalHandConfig());
  hand.moveBy({0, 0, -1e-3});
  hand.moveBy({0, 0, -1e-3});
  rest(hand, 0.4);
  EXPECT_NEAR(hand.position().z(), -2e-3, 1e-12);
  for (int i = 0; i < 100; ++i) hand.moveBy({0, 0, -1e-3});
  rest(hand, 0.45);
  EXPECT_NEAR(hand.position().z(), -7e-3, 1e-12);
}

TEST(GoalHand, AnOperatorWhoIsSilentIsGoneAndTheHandRests) {
  GoalHand hand(goalHandConfig());
  EXPECT_FALSE(hand.present());
  hand.moveTo({1, 0, 0});
  EXPECT_FALSE(hand.present());
  hand.stay();
  rest(hand, 0.499);
  EXPECT_TRUE(hand.present());
  hand.stay();
  rest(hand, 0.499);
  EXPECT_TRUE(hand.present());
  rest(hand, 0.002);
  EXPECT_FALSE(hand.present());
  const Eigen::Vector3d there = hand.position();
  rest(hand, 1);
  EXPECT_EQ(hand.position(), there);
  hand.stay();  // the old goal does not come back
  rest(hand, 0.1);
  EXPECT_EQ(hand.position(), there);
}

TEST(GoalHand, LettingGoStopsAtOnce) {
  GoalHand hand(goalHandConfig());
  hand.stay();
  hand.moveTo({1, 0, 0});
  rest(hand, 0.1);
  const Eigen::Vector3d there = hand.position();
  hand.release();
  EXPECT_FALSE(hand.present());
  rest(hand, 0.1);
  EXPECT_EQ(hand.position(), there);
}

}  // namespace
}  // namespace microinjection
