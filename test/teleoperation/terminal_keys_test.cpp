#include "teleoperation/terminal_keys.h"

#include <gtest/gtest.h>

#include <vector>

namespace microinjection {
namespace {

std::vector<std::string> keys(const std::string& bytes) {
  TerminalKeys keys;
  std::vector<std::string> all;
  for (const char byte : bytes) {
    if (const auto key = keys.feed(byte)) all.push_back(*key);
  }
  return all;
}

using Keys = std::vector<std::string>;

TEST(TerminalKeys, ReadsArrowsPagesAndLetters) {
  EXPECT_EQ(keys("\x1b[A\x1b[B\x1b[C\x1b[D"), Keys({"up", "down", "right", "left"}));
  EXPECT_EQ(keys("\x1bOA\x1bOD"), Keys({"up", "left"}));
  EXPECT_EQ(keys("\x1b[5~\x1b[6~"), Keys({"page_up", "page_down"}));
  EXPECT_EQ(keys("ei +"), Keys({"e", "i", " ", "+"}));
}

TEST(TerminalKeys, UnknownSequencesAreSwallowedWhole) {
  // F5, delete, ctrl-arrow, a reported place of the cursor, a new line, a letter beyond ASCII.
  EXPECT_EQ(keys("\x1b[15~w"), Keys({"w"}));
  EXPECT_EQ(keys("\x1b[3~\x1b[1;5Aw"), Keys({"w"}));
  EXPECT_EQ(keys("\x1b[24;80Rw"), Keys({"w"}));
  EXPECT_EQ(keys("\n\x03\xc3\xa9w"), Keys({"w"}));
}

TEST(TerminalKeys, EscapeAloneDoesNotEatTheNextKey) {
  EXPECT_EQ(keys("\x1b" "w"), Keys({"w"}));
  EXPECT_EQ(keys("\x1b\x1b[A"), Keys({"up"}));
}

}  // namespace
}  // namespace microinjection
