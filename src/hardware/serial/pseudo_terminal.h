#pragma once

#include <string>

namespace microinjection {

/// The emulator's end of a pseudo-terminal, with a link to the driver's end. The driver may close
/// and open its end at any time.
class PseudoTerminal {
 public:
  /// Connects. @throws ConfigError if the link cannot be made, e.g. because a file that is no link
  /// has its name.
  explicit PseudoTerminal(const std::string& link);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Bytes that the driver has written, possibly none. Does not block.
  std::string read();
  /// Bytes that do not fit because nobody reads are lost, as on a serial line.
  void write(const std::string& bytes);

  void disconnect();  ///< the driver sees a hang-up, and the link is removed
  void connect();     ///< creates a new terminal at the same link

 private:
  std::string link_;
  std::string slave_;  // path of the driver's end
  int master_ = -1;
  int kept_open_ = -1;  // the driver's end, so that a driver that closes it causes no hang-up here
};

}  // namespace microinjection
