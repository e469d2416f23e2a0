#pragma once

#include <string>

namespace microinjection {

/// A fault to be injected into an emulator: KIND[:VALUE][@TIME], for example "silence:2.0",
/// "drop:1@5.5", "interrupt".
///
///     silence:S   for S s the device neither receives nor sends (motions continue)
///     drop:N      the next N bytes from the device are lost
///     deaf:N      the next N bytes to the device are lost
///     garble:N    the next N bytes from the device have all bits inverted
///     error:CODE  the device answers the next command with this error
///     interrupt   all motion is stopped as if by hand
struct Fault {
  enum class Kind { kSilence, kDrop, kDeaf, kGarble, kError, kInterrupt };
  Kind kind = Kind::kInterrupt;
  double amount = 0;  ///< s of silence, or number of bytes
  std::string code;   ///< error code
  double time = 0;    ///< s, start
};

/// @throws ConfigError for an invalid `text`, with the allowed form.
Fault parseFault(const std::string& text);

}  // namespace microinjection
