#pragma once

#include <string>

namespace microinjection {

/// A fault that an emulator is asked for: KIND[:VALUE][@TIME], for example "silence:2.0", "drop:1@5.5", "interrupt".
///
///     silence:S   for S s it neither hears nor says anything (what moves goes on moving)
///     drop:N      the next N bytes that it says are lost
///     deaf:N      the next N bytes said to it are lost
///     garble:N    the next N bytes that it says arrive with all bits turned over
///     error:CODE  it answers the next command with this error of the device
///     interrupt   what moves is stopped as if by hand
struct Fault {
  enum class Kind { kSilence, kDrop, kDeaf, kGarble, kError, kInterrupt };
  Kind kind = Kind::kInterrupt;
  double amount = 0;  ///< s of silence, or number of bytes
  std::string code;   ///< of the error
  double time = 0;    ///< s, at which it begins
};

/// @throws ConfigError when `text` is none, saying what is allowed.
Fault parseFault(const std::string& text);

}  // namespace microinjection
