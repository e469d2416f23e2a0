#pragma once

#include <optional>
#include <string>

namespace microinjection {

/// Keys from the bytes that a terminal in raw mode sends (VT100 and xterm, in normal and
/// application mode).
class TerminalKeys {
 public:
  /// Returns the key that this byte completes: "up", "down", "left", "right", "page_up",
  /// "page_down", one printable character, or "other" for any other key (enter, tab, delete, with
  /// control, beyond ASCII). Empty while a sequence is incomplete.
  std::optional<std::string> feed(char byte);
  /// Call after dt (s) without a byte. Returns "other" when an incomplete sequence expires, as
  /// after the escape key alone.
  std::optional<std::string> wait(double dt);

 private:
  std::string pending_;      ///< incomplete sequence, which began with escape
  double waiting_time_ = 0;  ///< s, since its last byte
};

}  // namespace microinjection
