#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

#include "rig/serial/wire.h"

namespace microinjection {

/// Sends a device's stop for a program that cannot: one that has died without having closed the line (kill -9, SIGTERM,
/// a crash), or that stands still (SIGSTOP, a debugger, a swap storm) and so sends no beat for 0.2 s. It is a process
/// of its own that holds the line open. One that dies or stands still itself is replaced. end() sends nothing.
class StopGuard {
 public:
  StopGuard() = default;
  ~StopGuard() { end(); }
  StopGuard(const StopGuard&) = delete;
  StopGuard& operator=(const StopGuard&) = delete;

  /// `line`: descriptor of the open line, non-blocking, that outlives this. Empty, or why there is no guard.
  std::string begin(int line, const std::string& stop);
  /// To be called at every step of the driver; says what happened since the last call.
  Wire::GuardReport heartbeat();
  /// Whether the next heartbeat() has an intervention to say: until then nothing may be sent but a stop.
  bool intervened();
  void end();

  pid_t process() const { return process_; }  ///< -1: none

 private:
  using Clock = std::chrono::steady_clock;

  std::string start();
  void receive();
  void lose(const std::string& what);
  void endProcess();
  void reap();

  int line_ = -1;
  std::string stop_;
  pid_t process_ = -1;
  std::vector<pid_t> lost_;  // guards that were killed and have not ended yet
  int socket_ = -1;          // this end is closed when the program is gone
  Clock::time_point last_heartbeat_, last_start_;
  double silence_ = 0;  // s, of the guard
  std::string intervention_, missing_;
};

}  // namespace microinjection
