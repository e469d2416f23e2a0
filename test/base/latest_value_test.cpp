#include "base/latest_value.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <thread>

namespace microinjection {
namespace {

TEST(LatestValue, IsEmptyUntilSomethingIsWritten) {
  LatestValue<int> handed;
  EXPECT_FALSE(handed.update());
  EXPECT_EQ(handed.value(), 0);
}

TEST(LatestValue, GivesTheNewestAndEachOnce) {
  LatestValue<int> handed;
  for (int i = 1; i <= 5; ++i) handed.write(i);
  EXPECT_TRUE(handed.update());
  EXPECT_EQ(handed.value(), 5);
  EXPECT_FALSE(handed.update());
  EXPECT_EQ(handed.value(), 5);  // stays
  handed.write(6);
  EXPECT_EQ(handed.value(), 5);  // until it is asked for
  EXPECT_TRUE(handed.update());
  EXPECT_EQ(handed.value(), 6);
}

/// Values are long enough to be torn by a hand-over that is none; each is a number, over and over.
TEST(LatestValue, BetweenThreadsNoValueIsTornAndNoneComesBack) {
  using Value = std::array<std::uint64_t, 200>;
  constexpr std::uint64_t kLast = 200000;
  LatestValue<Value> handed;
  std::thread writer([&] {
    Value value;
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      value.fill(i);
      handed.write(value);
    }
  });
  std::uint64_t seen = 0, torn = 0, backwards = 0;
  while (seen != kLast) {
    if (!handed.update()) continue;
    const Value value = handed.value();
    if (std::any_of(value.begin(), value.end(), [&](std::uint64_t x) { return x != value[0]; })) ++torn;
    if (value[0] <= seen) ++backwards;
    seen = value[0];
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
}

}  // namespace
}  // namespace microinjection
