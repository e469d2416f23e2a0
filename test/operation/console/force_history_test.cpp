#include "operation/console/force_history.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

ForceHistory::Sample sample(double time, std::optional<double> depth, double force) {
  return {time, depth, force, force + 0.1e-6};
}

/// A contact of `points` samples from `begin` (s), a millisecond apart, that goes 1 um deeper in each.
void indent(ForceHistory& history, double begin, int points) {
  for (int i = 0; i < points; ++i) history.add(sample(begin + 1e-3 * i, 1e-6 * i, 0.5e-6 * i));
  history.add(sample(begin + 1e-3 * points, std::nullopt, 0));
}

TEST(ForceHistory, ShowsTheLastSeconds) {
  ForceHistory history;
  for (int i = 0; i <= 100; ++i) history.add(sample(0.5 * i, std::nullopt, 1e-6 * i));
  const PlotLine line = history.predictedOverTime();
  ASSERT_EQ(line.size(), 41U);
  EXPECT_DOUBLE_EQ(line.front().x, -ForceHistory::kWindow);
  EXPECT_DOUBLE_EQ(line.back().x, 0);
  EXPECT_DOUBLE_EQ(line.back().y, 100);
  EXPECT_DOUBLE_EQ(history.measuredOverTime().back().y, 100.1);
}

TEST(ForceHistory, HasNoPointForAnInvalidForce) {
  ForceHistory history;
  history.add({0, std::nullopt, 1e-6, std::nullopt});
  history.add({1, std::nullopt, std::nullopt, 2e-6});
  EXPECT_EQ(history.predictedOverTime().size(), 1U);
  EXPECT_EQ(history.measuredOverTime().size(), 1U);
}

TEST(ForceHistory, KeepsAContactUntilTheNextBegins) {
  ForceHistory history;
  indent(history, 0, 10);
  ASSERT_EQ(history.predictedOverDepth().size(), 10U);
  EXPECT_DOUBLE_EQ(history.predictedOverDepth().back().x, 9);
  EXPECT_DOUBLE_EQ(history.predictedOverDepth().back().y, 4.5);
  EXPECT_TRUE(history.past().empty());
  indent(history, 1, 3);
  ASSERT_EQ(history.past().size(), 1U);
  EXPECT_EQ(history.past()[0].size(), 10U);
  EXPECT_DOUBLE_EQ(history.past()[0].back().y, 4.6);
  EXPECT_EQ(history.measuredOverDepth().size(), 3U);
}

TEST(ForceHistory, KeepsTheLastContactsOnly) {
  ForceHistory history;
  for (int contact = 0; contact < 10; ++contact) indent(history, contact, contact + 1);
  EXPECT_EQ(history.past().size(), ForceHistory::kPastContacts);
  EXPECT_EQ(history.past().back().size(), 9U);
  EXPECT_EQ(history.contacts(), 10U);
}

TEST(ForceHistory, BoundsALongContact) {
  ForceHistory history;
  for (int i = 0; i < 100000; ++i) history.add(sample(1e-3 * i, 1e-9 * i, 0));
  EXPECT_LE(history.predictedOverDepth().size(), ForceHistory::kMostPoints);
  EXPECT_GE(history.predictedOverDepth().size(), ForceHistory::kMostPoints / 2);
  EXPECT_NEAR(history.predictedOverDepth().back().x, 99.999, 1e-9);
  EXPECT_NEAR(history.predictedOverDepth().front().x, 0, 1e-9);
}

TEST(ForceHistory, BeginsAnewWhenTheClockIsSetBack) {
  ForceHistory history;
  history.add(sample(100, std::nullopt, 1e-6));
  history.add(sample(1, std::nullopt, 2e-6));
  EXPECT_EQ(history.predictedOverTime().size(), 1U);
}

}  // namespace
}  // namespace microinjection
