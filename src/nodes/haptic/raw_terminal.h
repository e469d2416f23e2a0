#pragma once

#include <termios.h>

#include <string>

namespace microinjection {

/// The terminal of this program in raw mode: each key at once, without echo. The destructor
/// restores its mode.
class RawTerminal {
 public:
  /// @throws ConfigError when standard input is not a terminal.
  RawTerminal();
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  /// The bytes typed since the last call; never waits.
  std::string read();
  /// Replaces the present line.
  void show(const std::string& line);
  /// Whether the terminal was closed.
  bool closed() const { return closed_; }

 private:
  termios before_;
  std::string shown_;
  bool closed_ = false;
};

}  // namespace microinjection
