#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// Keys from the bytes that a terminal in raw mode sends (VT100 and xterm, in normal and application mode).
class TerminalKeys {
 public:
  /// The key that this byte completes: "up", "down", "left", "right", "page_up", "page_down", one printable character,
  /// or "other": a key was pressed, whichever (enter, tab, delete, with control, beyond ASCII). Empty while a sequence
  /// is incomplete.
  std::optional<std::string> feed(char byte);
  /// dt (s) without a byte: "other" when a sequence is no longer waited for, as after the escape key alone.
  std::optional<std::string> wait(double dt);

 private:
  std::string pending_;  ///< a sequence that has begun with escape
  double waited_ = 0;    ///< s, for the rest of it
};

}  // namespace microinjection
