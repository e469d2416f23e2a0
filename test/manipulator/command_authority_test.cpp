#include "manipulator/command_authority.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

constexpr double kTimeout = 0.1;

TEST(CommandAuthority, OneSourceCommandsAsOftenAsItLikes) {
  CommandAuthority authority;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(authority.admit("/controller", 0.03 * i, kTimeout, i % 2 == 0));
  EXPECT_EQ(authority.fault(), "");
}

TEST(CommandAuthority, ASecondSourceWithinTheTimeOutIsAFaultThatNamesBoth) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.admit("/controller", 1, kTimeout, false));
  EXPECT_FALSE(authority.admit("/stranger", 1 + 0.9 * kTimeout, kTimeout, false));
  EXPECT_EQ(authority.fault(), "two nodes command the needle: /controller and /stranger");
}

TEST(CommandAuthority, ASecondSourceIsAFaultAsLongAsTheNeedleMoves) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.admit("/controller", 1, kTimeout, false));
  EXPECT_FALSE(authority.admit("/stranger", 100, kTimeout, true));
}

TEST(CommandAuthority, AnotherMayCommandAfterTheFirstIsSilentAndTheNeedleRests) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.admit("/rostopic_1", 1, kTimeout, false));
  EXPECT_TRUE(authority.admit("/rostopic_2", 1 + 1.1 * kTimeout, kTimeout, false));
  EXPECT_FALSE(authority.admit("/rostopic_1", 1 + 1.2 * kTimeout, kTimeout, false));
}

TEST(CommandAuthority, AMoveIsOverWhenTheNeedleRests) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.admit("/person", 1, 0, false));
  EXPECT_TRUE(authority.admit("/controller", 1.001, kTimeout, false));
  EXPECT_EQ(authority.fault(), "");
}

TEST(CommandAuthority, TheFaultLastsForAllUntilItIsCleared) {
  CommandAuthority authority;
  authority.admit("/controller", 1, kTimeout, false);
  authority.admit("/stranger", 1, kTimeout, false);
  EXPECT_FALSE(authority.admit("/controller", 100, kTimeout, false));
  authority.clear();
  EXPECT_EQ(authority.fault(), "");
  EXPECT_TRUE(authority.admit("/stranger", 100, kTimeout, false));
}

}  // namespace
}  // namespace microinjection
