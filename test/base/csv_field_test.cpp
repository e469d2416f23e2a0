#include "base/csv_field.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

TEST(CsvField, OnlyWhatWouldEndAFieldIsQuoted) {
  EXPECT_EQ(csvField("17.9e3"), "17.9e3");
  EXPECT_EQ(csvField("neo hookean"), "neo hookean");
  EXPECT_EQ(csvField(""), "");
  EXPECT_EQ(csvField("1,5"), "\"1,5\"");
  EXPECT_EQ(csvField("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csvField("a\nb"), "\"a\nb\"");
  EXPECT_EQ(csvField("a\rb"), "\"a\rb\"");
}

}  // namespace
}  // namespace microinjection
