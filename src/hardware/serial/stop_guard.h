#pragma once

#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

#include "hardware/serial/wire.h"

namespace microinjection {

/// Sends a device's stop when the program cannot: when it died without closing the line (kill -9,
/// SIGTERM, a crash), or when it is frozen (SIGSTOP, a debugger, swapping) and sends no heartbeat
/// for 0.2 s. The guard is a process of its own that holds the line open. A guard that dies or
/// freezes is replaced. end() sends nothing.
class StopGuard {
 public:
  StopGuard() = default;
  ~StopGuard() { end(); }
  StopGuard(const StopGuard&) = delete;
  StopGuard& operator=(const StopGuard&) = delete;

  /// `line`: non-blocking descriptor of the open line, which must outlive this object. Returns an
  /// empty text, or the reason why there is no guard. `apart`: s between two stops, see
  /// Wire::setStopsApart(); 0: 0.2 s, and one stop at the end.
  std::string begin(int line, const std::string& stop, double apart = 0);
  /// Must be called in every step of the driver. Reports what occurred since the last call.
  Wire::GuardReport heartbeat();
  /// True if the next heartbeat() will report an intervention. Until then only a stop may be sent.
  bool intervened();
  void end();
  /// Ends as a death of this program does.
  void leave();

  pid_t process() const { return process_; }  ///< -1: none

 private:
  using Clock = std::chrono::steady_clock;

  std::string start();
  void receive();
  void markLost(const std::string& what);
  void endProcess();
  void reap();

  int line_ = -1;
  std::string stop_;
  double apart_ = 0;  // s
  pid_t process_ = -1;
  std::vector<pid_t> lost_;  // killed guards that have not terminated yet
  int socket_ = -1;          // the system closes this end when the program terminates
  Clock::time_point last_heartbeat_, last_start_;
  double silence_ = 0;  // s, since the guard's last message
  std::string intervention_, missing_;
};

}  // namespace microinjection
