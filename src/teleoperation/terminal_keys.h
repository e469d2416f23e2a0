#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// Keys from the bytes that a terminal in raw mode sends (VT100 and xterm, in normal and application mode).
class TerminalKeys {
 public:
  /// The key that this byte completes: "up", "down", "left", "right", "page_up", "page_down" or one printable
  /// character. Empty while a sequence is incomplete, and for what is not known.
  std::optional<std::string> feed(char byte);

 private:
  std::string pending_;  ///< a sequence that has begun with escape
};

}  // namespace microinjection
