#pragma once

#include <termios.h>

#include <string>

namespace microinjection {

/// What a mode of a serial line would change in bytes that pass it, by termios' names such as "ISTRIP, IXON"; empty:
/// nothing. A system may keep a setting and report no error (POSIX, tcsetattr), so it is read back: one stripped bit
/// of a binary target sends a needle elsewhere.
std::string whatChangesBytes(const termios& mode);

}  // namespace microinjection
