#include "hardware/serial/line_mode.h"

#include <gtest/gtest.h>

#include <utility>

namespace microinjection {
namespace {

/// Of a terminal as people type into it, and of a line that a driver opens.
TEST(LineMode, TheModeOfATerminalChangesBytesAndARawOneNone) {
  termios mode{};
  mode.c_cflag = CS8;
  mode.c_iflag = ICRNL | IXON;
  mode.c_oflag = OPOST;
  mode.c_lflag = ECHO | ICANON | ISIG;
  EXPECT_EQ(whatChangesBytes(mode), "ICRNL, IXON, OPOST, ECHO, ICANON, ISIG");
  cfmakeraw(&mode);
  EXPECT_EQ(whatChangesBytes(mode), "");
}

TEST(LineMode, EachSettingIsNamed) {
  for (const auto& [flag, name] :
       {std::pair(ISTRIP, "ISTRIP"), {INLCR, "INLCR"}, {IGNCR, "IGNCR"}, {IXOFF, "IXOFF"}, {PARMRK, "PARMRK"}}) {
    termios mode{};
    mode.c_cflag = CS8;
    mode.c_iflag = static_cast<tcflag_t>(flag);
    EXPECT_EQ(whatChangesBytes(mode), name);
  }
  termios seven{};
  seven.c_cflag = CS7;
  EXPECT_EQ(whatChangesBytes(seven), "CS5 to CS7");
}

}  // namespace
}  // namespace microinjection
