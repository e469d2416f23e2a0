#pragma once

#include <termios.h>

#include <string>

namespace microinjection {

/// The terminal of this program, each key at once and not shown; as before when it is destroyed.
class RawTerminal {
 public:
  /// @throws ConfigError when standard input is no terminal.
  RawTerminal();
  ~RawTerminal();
  RawTerminal(const RawTerminal&) = delete;
  RawTerminal& operator=(const RawTerminal&) = delete;

  /// What was typed since the last call; never waits.
  std::string read();
  /// Writes over the present line.
  void show(const std::string& line);
  /// The terminal is gone.
  bool closed() const { return closed_; }

 private:
  termios before_;
  std::string shown_;
  bool closed_ = false;
};

}  // namespace microinjection
