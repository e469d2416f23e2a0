#include "operation/display/tip_trail.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(TipTrail, IsTheWayOfTheLastSecondsAndFades) {
  TipTrail trail(10);
  for (int second = 0; second <= 20; ++second) trail.add(second, {0, 0, second * 1e-6});
  const ColouredLines way = trail.lines();
  ASSERT_EQ(way.lines.size(), 2u * 10);
  EXPECT_NEAR(way.lines.front().z(), 0.1, 1e-9);  // 10 um, 10 s ago
  EXPECT_NEAR(way.lines.back().z(), 0.2, 1e-9);
  EXPECT_NEAR(way.colours.front().a, 0, 1e-6);
  EXPECT_GT(way.colours.back().a, 0.8);
}

TEST(TipTrail, OfANeedleThatRestsIsEmpty) {
  TipTrail trail(10);
  for (int i = 0; i < 100; ++i) trail.add(0.1 * i, {1e-6, 0, 1e-9 * (i % 2)});
  EXPECT_TRUE(trail.lines().lines.empty());
}

TEST(TipTrail, AClockThatWasSetBackBeginsAnew) {
  TipTrail trail(10);
  trail.add(50, {0, 0, 0});
  trail.add(51, {0, 0, 1e-6});
  trail.add(1, {0, 0, 2e-6});
  EXPECT_TRUE(trail.lines().lines.empty());
}

}  // namespace
}  // namespace microinjection
