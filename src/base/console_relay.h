#pragma once

#include <memory>

namespace microinjection {

/// Decouples this process from its terminal. Standard output and standard error go into a pipe, and
/// a separate thread writes them on. A stopped terminal (Ctrl-S, a hung ssh) or a hanging disk
/// therefore never blocks a control loop in a write. The buffer holds at most 1 MiB. Output beyond
/// that is dropped, and the number of dropped lines is written when the terminal accepts output
/// again.
///
/// Create at most one in a process, before other threads start. If no pipe can be made, output
/// stays as it is.
class ConsoleRelay {
 public:
  ConsoleRelay();
  /// Restores standard output and error. Waits at most half a second for a stopped terminal.
  ~ConsoleRelay();
  ConsoleRelay(const ConsoleRelay&) = delete;
  ConsoleRelay& operator=(const ConsoleRelay&) = delete;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;  // shared with the threads, because a stopped terminal can block one of them
};

}  // namespace microinjection
