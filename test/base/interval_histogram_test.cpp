#include "base/interval_histogram.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(IntervalHistogram, QuantilesOfAKnownDistribution) {
  IntervalHistogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.add(1e-6 * i);
  EXPECT_EQ(histogram.count(), 1000u);
  for (const double q : {0.01, 0.1, 0.5, 0.9, 0.99}) EXPECT_NEAR(histogram.quantile(q) / (1e-3 * q), 1, 0.021) << q;
  EXPECT_DOUBLE_EQ(histogram.largest(), 1e-3);
}

TEST(IntervalHistogram, OneValueIsAllItsQuantiles) {
  IntervalHistogram histogram;
  for (int i = 0; i < 10; ++i) histogram.add(0.0123);
  EXPECT_NEAR(histogram.quantile(0.01), 0.0123, 0.0123 * 0.0101);
  EXPECT_NEAR(histogram.quantile(1.0), 0.0123, 0.0123 * 0.0101);
}

TEST(IntervalHistogram, RareStallShowsInTheTailAlone) {
  IntervalHistogram histogram;
  for (int i = 0; i < 999; ++i) histogram.add(1e-3);
  histogram.add(2.0);
  EXPECT_NEAR(histogram.quantile(0.99), 1e-3, 2e-5);
  EXPECT_NEAR(histogram.quantile(0.9999), 2.0, 0.03);
}

TEST(IntervalHistogram, KeepsWhatLiesOutsideOfItsBins) {
  IntervalHistogram histogram;
  histogram.add(0);
  histogram.add(-1);  // a clock set back
  histogram.add(1e6);
  EXPECT_EQ(histogram.count(), 3u);
  EXPECT_LT(histogram.quantile(0.5), 2e-7);
  EXPECT_DOUBLE_EQ(histogram.largest(), 1e6);
}

TEST(IntervalHistogram, ItsLimitIsExact) {
  IntervalHistogram histogram(2e-3);
  for (const double duration : {1e-3, 1.9999e-3, 2e-3, 2.0001e-3, 5.0}) histogram.add(duration);
  EXPECT_EQ(histogram.countOverLimit(), 2u);
}

TEST(IntervalHistogram, ItsBinsHoldWhatWasAdded) {
  IntervalHistogram histogram;
  for (const double duration : {3e-3, 1e-3, 1e-3, 1e-3}) histogram.add(duration);
  const auto bins = histogram.bins();
  ASSERT_EQ(bins.size(), 2u);
  EXPECT_EQ(bins[0].count, 3u);
  EXPECT_EQ(bins[1].count, 1u);
  EXPECT_GE(bins[0].upper, 1e-3);
  EXPECT_LT(bins[0].upper, 1.021e-3);
  EXPECT_GE(bins[1].upper, 3e-3);
}

TEST(IntervalHistogram, EmptyIsZero) {
  EXPECT_EQ(IntervalHistogram().quantile(0.5), 0);
  EXPECT_EQ(IntervalHistogram().largest(), 0);
}

}  // namespace
}  // namespace microinjection
