#include "nodes/runtime/awake_time.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(AwakeTime, CountsTheTimeBetweenSteps) {
  AwakeTime awake;
  for (int i = 0; i <= 20; ++i) awake.step(ros::SteadyTime(10 + 0.05 * i));
  EXPECT_NEAR(awake.seconds(), 1, 1e-6);
}

TEST(AwakeTime, AStepThatComesLateCountsAsALongOneAtMost) {
  AwakeTime awake;
  awake.step(ros::SteadyTime(10));
  awake.step(ros::SteadyTime(15));
  EXPECT_NEAR(awake.seconds(), AwakeTime::kLongestStep, 1e-6);
}

}  // namespace
}  // namespace microinjection
