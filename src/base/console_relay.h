#pragma once

#include <cstdint>
#include <memory>

namespace microinjection {

/// Stands between this process and its terminal. What is written to standard output and standard error goes into a
/// pipe, and a thread of its own writes it on: a terminal that is stopped (Ctrl-S, a hung ssh) or a disk that hangs
/// never makes a loop wait in a write. At most 1 MiB waits for the terminal. What does not fit is dropped, and the
/// number of lines that were dropped is written when the terminal takes output again.
///
/// One of them in a process, before there are other threads. Where there are no pipes left, output stays as it is.
class ConsoleRelay {
 public:
  ConsoleRelay();
  /// Standard output and error are as they were before. Waits half a second at the most for a terminal that is stopped.
  ~ConsoleRelay();
  ConsoleRelay(const ConsoleRelay&) = delete;
  ConsoleRelay& operator=(const ConsoleRelay&) = delete;

  std::uint64_t droppedLines() const;  ///< since the start

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;  // the threads', too: a terminal that is stopped keeps one of them waiting
};

}  // namespace microinjection
