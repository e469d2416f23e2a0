#include "hardware/manipulator/command_authority.h"

#include <gtest/gtest.h>

#include <string>

namespace microinjection {
namespace {

class CommandAuthorityTest : public testing::Test {
 protected:
  bool command(const std::string& source) { return authority_.authorize(source, time_); }
  void step(bool moving) { authority_.step(time_ += 1e-3, moving); }

  CommandAuthority authority_;
  double time_ = 1;
};

TEST_F(CommandAuthorityTest, OneSourceCommandsAsOftenAsItLikes) {
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(command("/controller"));
    step(i % 2 == 0);
  }
  EXPECT_EQ(authority_.fault(), "");
}

TEST_F(CommandAuthorityTest, ASecondSourceInTheSameStepIsAFaultThatNamesBoth) {
  EXPECT_TRUE(command("/controller"));
  EXPECT_FALSE(command("/stranger"));
  EXPECT_EQ(authority_.fault(), "two nodes command the needle: /controller and /stranger");
}

TEST_F(CommandAuthorityTest, TheStepOfACommandIsNoRestBeforeTheDeviceHasIt) {
  EXPECT_TRUE(command("/controller"));
  authority_.step(time_, false);
  EXPECT_FALSE(command("/stranger"));
}

TEST_F(CommandAuthorityTest, TwoStreamsAreAFaultAsSoonAsTheSecondOneMovesTheNeedle) {
  EXPECT_TRUE(command("/controller"));
  step(false);
  EXPECT_TRUE(command("/stranger"));
  step(true);
  EXPECT_FALSE(command("/controller"));
}

TEST_F(CommandAuthorityTest, ASecondSourceIsAFaultAsLongAsTheNeedleMoves) {
  EXPECT_TRUE(command("/controller"));
  for (int i = 0; i < 1000; ++i) step(true);
  EXPECT_FALSE(command("/stranger"));
}

TEST_F(CommandAuthorityTest, AnotherMayCommandWhenTheNeedleRests) {
  EXPECT_TRUE(command("/rostopic_1"));
  step(true);
  step(false);
  EXPECT_TRUE(command("/rostopic_2"));
}

TEST_F(CommandAuthorityTest, ADeviceThatCorrectsItsPositionAtRestHoldsNobodyOff) {
  EXPECT_TRUE(command("/rostopic"));
  step(true);
  step(false);  // is_busy becomes false
  step(true);
  EXPECT_TRUE(command("/controller"));
}

TEST_F(CommandAuthorityTest, TheFaultLastsForAllUntilItIsCleared) {
  command("/controller");
  command("/stranger");
  step(false);
  EXPECT_FALSE(command("/controller"));
  authority_.clear();
  EXPECT_EQ(authority_.fault(), "");
  EXPECT_TRUE(command("/stranger"));
}

}  // namespace
}  // namespace microinjection
