#pragma once

#include <string>

namespace microinjection {

/// The emulator's side of a pseudo-terminal, with a link to the driver's side at a path of its own. The driver may
/// close and open its side as often as it likes.
class PseudoTerminal {
 public:
  /// Plugs it in. @throws ConfigError when the link cannot be made, e.g. because there is a file that is no link.
  explicit PseudoTerminal(const std::string& link);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Bytes that the driver has written, perhaps none; does not wait.
  std::string read();
  /// What does not fit because nobody reads is lost, as it is on a serial line.
  void write(const std::string& bytes);

  void unplug();  ///< the driver's side hangs up, and the link is gone
  void plug();    ///< a new terminal behind the same link

 private:
  std::string link_;
  std::string slave_;  // path of the driver's side
  int master_ = -1;
  int kept_open_ = -1;  // the driver's side, so that its closing is no hang-up here
};

}  // namespace microinjection
