#include "base/parse_number.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(ParseNumber, TakesTheWholeText) {
  EXPECT_EQ(parseNumber<double>("-2.5e-3"), -2.5e-3);
  EXPECT_EQ(parseNumber<double>("  007.5"), 7.5);
  EXPECT_EQ(parseNumber<long>("+12"), 12);
  for (const char* none : {"", " ", "x", "1x", "1 ", "1,5", "inf", "nan", "0x10", "1e999"}) {
    EXPECT_FALSE(parseNumber<double>(none)) << none;
  }
}

TEST(ParseNumber, AWholeNumberHasNoPointAndFitsItsType) {
  EXPECT_EQ(parseNumber<int>("-2147483648"), -2147483647 - 1);
  EXPECT_EQ(parseNumber<long>("2147483648"), 2147483648L);
  for (const char* none : {"1.0", "1e3", "2147483648", "--1"}) EXPECT_FALSE(parseNumber<int>(none)) << none;
}

}  // namespace
}  // namespace microinjection
