#include "hardware/serial/emulated_line.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(LineTiming, AByteTakesTenBitTimes) {
  // 13 bytes at 9600 baud: 13.54 ms.
  LineTiming line(9600);
  line.put(std::string(13, 'x'), 1);
  EXPECT_EQ(line.receive(1 + 1.04e-3).size(), 0u);
  EXPECT_EQ(line.receive(1 + 1.05e-3).size(), 1u);
  const auto rest = line.receive(1 + 13.55e-3);
  ASSERT_EQ(rest.size(), 12u);
  EXPECT_NEAR(rest.back().time, 1 + 13.0 * 10 / 9600, 1e-12);
}

TEST(LineTiming, BytesQueueBehindThoseOnTheirWay) {
  LineTiming line(1000);  // 10 ms a byte
  line.put("ab", 0);
  line.put("c", 5e-3);
  EXPECT_EQ(line.receive(29e-3).size(), 2u);
  ASSERT_EQ(line.receive(31e-3).size(), 1u);
  line.put("d", 1);  // after a pause it begins at once
  EXPECT_EQ(line.receive(1.011).size(), 1u);
}

}  // namespace
}  // namespace microinjection
