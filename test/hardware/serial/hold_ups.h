#pragma once

#include <sys/types.h>

#include <chrono>
#include <fstream>
#include <string>

namespace microinjection {

/// Whether the machine held this program or its stop guard up, so that one of them was right to take the other for
/// frozen.
class HoldUps {
 public:
  explicit HoldUps(pid_t guard) { restart(guard); }

  /// From here on both go on: neither rests on purpose.
  void restart(pid_t guard) {
    stepped_ = ticked_ = Clock::now();
    waits_ = waitsOf(guard);
  }
  /// In every step of this program. `guard`: its present process; -1: none.
  void note(pid_t guard) {
    constexpr std::chrono::milliseconds kLong(100);
    const Clock::time_point now = Clock::now();
    const long waits = waitsOf(guard);
    if (waits != waits_ || guard < 0) ticked_ = now;
    any_ = any_ || now - stepped_ > kLong || now - ticked_ > kLong;
    waits_ = waits;
    stepped_ = now;
  }
  bool any() const { return any_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// The guard waits at the end of each of its ticks.
  static long waitsOf(pid_t guard) {
    std::ifstream status("/proc/" + std::to_string(guard) + "/status");
    for (std::string word; status >> word;) {
      long waits = 0;
      if (word == "voluntary_ctxt_switches:" && status >> waits) return waits;
    }
    return -1;
  }

  Clock::time_point stepped_, ticked_;  // when this program stepped last, and the guard was last seen to have
  long waits_ = 0;
  bool any_ = false;
};

}  // namespace microinjection
