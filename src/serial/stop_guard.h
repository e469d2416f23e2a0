#pragma once

#include <sys/types.h>

#include <string>

namespace microinjection {

/// Bytes that go out on a line when this program dies without having closed it (kill -9, SIGTERM, a crash): a process
/// of its own keeps the line open, and says them when it no longer has a parent. Say nothing: end() or the destructor.
class StopGuard {
 public:
  StopGuard() = default;
  ~StopGuard() { end(); }
  StopGuard(const StopGuard&) = delete;
  StopGuard& operator=(const StopGuard&) = delete;

  /// `line`: descriptor of the open line. Empty, or why there is nobody to say them.
  std::string begin(int line, const std::string& words);
  void end();

 private:
  pid_t guard_ = -1;
  int parent_ = -1;  // this end of the pipe closes when the program is gone
};

}  // namespace microinjection
