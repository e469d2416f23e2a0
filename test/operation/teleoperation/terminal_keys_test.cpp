#include "operation/teleoperation/terminal_keys.h"

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

TEST(TerminalKeys, AnUnknownKeyIsAKeyNonetheless) {
  // F5, delete, control and an arrow, a reported place of the cursor, a sequence that does not end.
  EXPECT_EQ(keys("\x1b[15~w"), Keys({"other", "w"}));
  EXPECT_EQ(keys("\x1b[3~\x1b[1;5Bw"), Keys({"other", "other", "w"}));
  EXPECT_EQ(keys("\x1b[24;80Rw"), Keys({"other", "w"}));
  EXPECT_EQ(keys("\x1b[1234567"), Keys({"other"}));
  // Enter, line feed, tab, backspace twice, control-c, a letter beyond ASCII.
  for (const char* one : {"\r", "\n", "\t", "\x7f", "\b", "\x03"}) EXPECT_EQ(keys(one), Keys({"other"}));
  EXPECT_EQ(keys("\xc3\xa9w"), Keys({"other", "other", "w"}));
}

TEST(TerminalKeys, EscapeAloneDoesNotEatTheNextKey) {
  EXPECT_EQ(keys("\x1b"
                 "w"),
            Keys({"w"}));
  EXPECT_EQ(keys("\x1b\x1b[A"), Keys({"other", "up"}));
}

TEST(TerminalKeys, EscapeAloneIsAKeyWhenNothingFollows) {
  TerminalKeys keys;
  const auto waits = [&keys](int steps) {
    std::optional<std::string> key;
    for (int i = 0; i < steps && !key; ++i) key = keys.wait(5e-3);
    return key;
  };
  EXPECT_FALSE(waits(1000)) << "nothing was pressed";
  keys.feed('\x1b');
  EXPECT_FALSE(waits(8));
  EXPECT_EQ(waits(3), "other");
  EXPECT_FALSE(waits(1000)) << "once";
  keys.feed('\x1b');
  waits(8);
  EXPECT_FALSE(keys.feed('['));
  EXPECT_FALSE(waits(8)) << "a sequence that comes slowly";
  EXPECT_EQ(keys.feed('B'), "down");
  EXPECT_FALSE(waits(1000));
}

}  // namespace
}  // namespace microinjection
