#include "base/busy_report.h"

#include <gtest/gtest.h>

#include <string>

namespace microinjection {
namespace {

/// What was said, a letter for each change: T and F.
std::string changes(BusyReport& report, const std::string& busy, std::int64_t from) {
  std::string said;
  bool last = false;
  for (const char each : busy) {
    const bool now = report.step(each == '1', ++from);
    if (now != last) said += now ? "T" : "F";
    last = now;
  }
  return said;
}

TEST(BusyReport, AMotionBringsOneTrueAndOneFalse) {
  BusyReport report;
  report.accept(10);
  EXPECT_EQ(changes(report, "11110000", 10), "TF");
}

TEST(BusyReport, SoDoesOneOfNoLength) {
  BusyReport report;
  report.accept(10);
  EXPECT_EQ(changes(report, "0000", 10), "TF");
}

TEST(BusyReport, OneThatTakesOverEndsTheOneBefore) {
  BusyReport report;
  report.accept(0);
  ASSERT_TRUE(report.step(true, 1));
  report.accept(1);
  EXPECT_FALSE(report.step(true, 2));
  EXPECT_TRUE(report.step(true, 3));
  EXPECT_TRUE(report.step(true, 4));
  EXPECT_FALSE(report.step(false, 5));
}

TEST(BusyReport, ATrueIsLaterThanTheCommand) {
  BusyReport report;
  report.accept(10);
  EXPECT_FALSE(report.step(true, 9));   // a step that had begun before the command came
  EXPECT_FALSE(report.step(true, 10));  // who sent it at 10 waits for a later stamp
  EXPECT_TRUE(report.pending());
  EXPECT_TRUE(report.step(true, 11));
  EXPECT_FALSE(report.pending());
}

TEST(BusyReport, AClockThatIsSetBackKeepsNothingBack) {
  BusyReport report;
  ASSERT_FALSE(report.step(false, 1000));
  report.accept(1001);
  EXPECT_TRUE(report.step(true, 5));
}

TEST(BusyReport, ManyMotionsBetweenTwoStepsAreOne) {
  BusyReport report;
  for (int i = 0; i < 5; ++i) report.accept(1);
  EXPECT_EQ(changes(report, "111000", 1), "TF");
}

}  // namespace
}  // namespace microinjection
