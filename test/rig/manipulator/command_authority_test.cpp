#include "rig/manipulator/command_authority.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(CommandAuthority, OneSourceCommandsAsOftenAsItLikes) {
  CommandAuthority authority;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(authority.authorize("/controller", 0.03 * i, i % 2 == 0));
  EXPECT_EQ(authority.fault(), "");
}

TEST(CommandAuthority, ASecondSourceInTheSameStepIsAFaultThatNamesBoth) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.authorize("/controller", 1, false));
  EXPECT_FALSE(authority.authorize("/stranger", 1, false));
  EXPECT_EQ(authority.fault(), "two nodes command the needle: /controller and /stranger");
}

TEST(CommandAuthority, TwoStreamsAreAFaultAsSoonAsTheSecondOneMovesTheNeedle) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.authorize("/controller", 1, false));
  EXPECT_TRUE(authority.authorize("/stranger", 1.001, false));
  EXPECT_FALSE(authority.authorize("/controller", 1.002, true));
}

TEST(CommandAuthority, ASecondSourceIsAFaultAsLongAsTheNeedleMoves) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.authorize("/controller", 1, false));
  EXPECT_FALSE(authority.authorize("/stranger", 100, true));
}

TEST(CommandAuthority, AnotherMayCommandWhenTheNeedleRests) {
  CommandAuthority authority;
  EXPECT_TRUE(authority.authorize("/rostopic_1", 1, false));
  EXPECT_FALSE(CommandAuthority(authority).authorize("/rostopic_2", 1.1, true));
  EXPECT_TRUE(authority.authorize("/rostopic_2", 1.1, false));
}

TEST(CommandAuthority, TheFaultLastsForAllUntilItIsCleared) {
  CommandAuthority authority;
  authority.authorize("/controller", 1, false);
  authority.authorize("/stranger", 1, false);
  EXPECT_FALSE(authority.authorize("/controller", 100, false));
  authority.clear();
  EXPECT_EQ(authority.fault(), "");
  EXPECT_TRUE(authority.authorize("/stranger", 100, false));
}

}  // namespace
}  // namespace microinjection
